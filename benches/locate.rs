//! Time point location: `cargo bench --bench locate`.
//!
//! 40 curves of 4000 cubics in all, one above the other, each with an island; one query at a time on one thread.

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use stickslip::tracer::{Curve, Node, Point, Subdivision, Vertex, VertexKind, Window};

const WAVES: u32 = 20;

fn plane() -> (Vec<Curve<u32, u32>>, Vec<Vertex<u32>>) {
    let (mut curves, mut vertices) = (Vec::new(), Vec::new());
    for wave in 0..WAVES {
        let lift = (f64::from(wave) + 0.6) / f64::from(WAVES);
        let node = |i: u32| {
            let x = f64::from(i) / 100.0;
            let (sin, cos) = (9.0 * x).sin_cos();
            let (point, along) = (Point::new(x, lift + 0.015 * sin), Point::new(1.0, 0.135 * cos));
            Node { point, tangent: along.normalize() }
        };
        let nodes: Vec<Node> = (0..=100).map(node).collect();
        for end in [nodes[0], nodes[100]] {
            let (point, kind) = (end.point, VertexKind::WindowEdge);
            vertices.push(Vertex { point, kind, margins: vec![wave] });
        }
        let first = 2 * wave as usize;
        let ends = Some([first, first + 1]);
        curves.push(Curve { margin: wave, sides: [wave + 1, wave], nodes, ends });
        let node = |i: u32| {
            let (sin, cos) = (TAU * f64::from(i) / 100.0).sin_cos();
            let centre = Point::new((f64::from(wave) + 0.5) / f64::from(WAVES), lift - 0.025);
            let point = centre + 0.003 * Point::new(cos, sin);
            Node { point, tangent: Point::new(-sin, cos) }
        };
        let nodes = (0..100).map(node).collect();
        curves.push(Curve { margin: wave, sides: [WAVES + 1 + wave, wave], nodes, ends: None });
    }
    (curves, vertices)
}

fn locate(criterion: &mut Criterion) {
    let window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };
    let (curves, vertices) = plane();
    let make = || Subdivision::new(window, curves.clone(), vertices.clone(), 1e-7);
    let plane = make().expect("curves with a meaning");
    assert!(plane.findings().is_empty() && plane.regions().len() == 41, "{:?}", plane.findings());
    let mut random = fastrand::Rng::with_seed(1);
    let points: Vec<Point> = (0..10_000).map(|_| Point::new(random.f64(), random.f64())).collect();
    let mut group = criterion.benchmark_group("subdivision");
    group.bench_function("new", |bencher| bencher.iter(|| make().map(|plane| plane.euler())));
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("locate", |bencher| {
        bencher.iter(|| {
            for point in &points {
                black_box(plane.locate(black_box(point)));
            }
        });
    });
    group.bench_function("vertical_distance", |bencher| {
        bencher.iter(|| {
            for point in &points {
                black_box(plane.vertical_distance(black_box(point)));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, locate);
criterion_main!(benches);
