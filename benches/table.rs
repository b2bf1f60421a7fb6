//! Time a look-up in a table of ε_t: `cargo bench --bench table`.
//!
//! One look-up at a time on one thread, at points at random over the whole window and at a hundred
//! points again and again, beside the exact engine.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fastrand::Rng;
use stickslip::model::{Collision, Contact, exact};
use stickslip::plane::progress;
use stickslip_practice::tables::{self, TableSettings};

const POINTS: usize = 100_000;

fn look_up(criterion: &mut Criterion) {
    let settings = TableSettings::default();
    let table = tables::run(&settings, progress::SILENT).expect("a table");
    let mut random = Rng::with_seed(1);
    let [(k0, k1), (p0, p1)] = table.window.sides().map(|side| (side.low, side.high));
    let mut point = || [(k0 * (k1 / k0).powf(random.f64())).min(k1), p0 + (p1 - p0) * random.f64()];
    let points: Vec<[f64; 2]> = (0..POINTS).map(|_| point()).collect();
    let near: Vec<[f64; 2]> = (0..POINTS).map(|k| points[k % 100]).collect();
    let mut group = criterion.benchmark_group("table to 1e-8");
    group.throughput(Throughput::Elements(POINTS as u64));
    for (name, points) in [("at random", &points), ("a hundred points", &near)] {
        group.bench_function(name, |bencher| {
            bencher
                .iter(|| points.iter().map(|&[kappa, psi]| table.eps_t(kappa, psi)).sum::<f64>());
        });
    }
    group.sample_size(10);
    let mut collision = Collision::before(Contact::new(1.0, 1.0, 0.0).expect("valid"));
    group.bench_function("exact engine", |bencher| {
        bencher.iter(|| {
            for &[kappa, psi] in &points {
                let contact = Contact::new(kappa, psi, 0.0).expect("valid");
                exact::collide_into(contact, &mut collision).expect("a collision");
                black_box(collision.final_velocity);
            }
        });
    });
    group.finish();
}

criterion_group!(benches, look_up);
criterion_main!(benches);
