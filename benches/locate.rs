//! Time point location: `cargo bench --bench locate`.
//!
//! One query at a time on one thread.

use std::hint::black_box;

use benches::plane;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn locate(criterion: &mut Criterion) {
    let input = plane::curves();
    let plane = plane::subdivision(input.clone());
    let points = plane::points();
    let mut group = criterion.benchmark_group("subdivision");
    group.bench_function("new", |bencher| bencher.iter(|| plane::subdivision(input.clone())));
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
