//! Time whole runs of systems, native and from text: `cargo bench --bench systems`.
//!
//! Both decide their guards. A native system has a fixed dimension; a text runs as instructions.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use stickslip::solver::dynamic::run_dynamic;
use stickslip::solver::{
    Direction, Dop853, Guard, Number, Options, ReadableSystem, Start, State, run,
};
use stickslip_expression::System;

/// x″ = −x, reported where x crosses 0.5.
struct Oscillator;

impl ReadableSystem<2, 1> for Oscillator {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _: T, y: &[T; 2]) -> [T; 2] {
        [y[1], -y[0]]
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T; 2]) -> [T; 1] {
        [y[0] - 0.5]
    }
}

const OSCILLATOR: &str = "state x = 0, v = 1\nx' = v\nv' = -x\nwhen x crosses 0.5\nend = 100";

/// A planet, reported where it is nearest and farthest.
struct Kepler;

impl ReadableSystem<4, 1> for Kepler {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _: T, y: &[T; 4]) -> [T; 4] {
        let square = y[0] * y[0] + y[1] * y[1];
        let cube = square * square.sqrt();
        [y[2], y[3], -y[0] / cube, -y[1] / cube]
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T; 4]) -> [T; 1] {
        [y[0] * y[2] + y[1] * y[3]]
    }
}

const KEPLER: &str = "state x = 0.5, y = 0, u = 0, v = sqrt(3)\nsquare = x*x + y*y\n\
    cube = square*sqrt(square)\nx' = u\ny' = v\nu' = -x/cube\nv' = -y/cube\n\
    when x*u + y*v crosses 0\nend = 62.8";

/// A satellite between the earth and the moon, reported where it crosses the line between them.
struct Arenstorf;

const MU: f64 = 0.012277471;

impl ReadableSystem<4, 1> for Arenstorf {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _: T, &[x, y, u, v]: &[T; 4]) -> [T; 4] {
        let cube = |a: T| {
            let square = a * a + y * y;
            square * square.sqrt()
        };
        let (earth, moon) = (cube(x + MU), cube(x - (1.0 - MU)));
        let pull_x = (x + MU) * (1.0 - MU) / earth + (x - (1.0 - MU)) * MU / moon;
        let pull_y = y * (1.0 - MU) / earth + y * MU / moon;
        [u, v, x + v * 2.0 - pull_x, y - u * 2.0 - pull_y]
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Either)]
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T; 4]) -> [T; 1] {
        [y[1]]
    }
}

const ARENSTORF: &str = "parameter mu = 0.012277471\n\
    state x = 0.994, y = 0, u = 0, v = -2.00158510637908252240537862224\n\
    a = (x + mu)*(x + mu) + y*y\nb = (x - (1 - mu))*(x - (1 - mu)) + y*y\n\
    earth = a*sqrt(a)\nmoon = b*sqrt(b)\nx' = u\ny' = v\n\
    u' = x + v*2 - ((x + mu)*(1 - mu)/earth + (x - (1 - mu))*mu/moon)\n\
    v' = y - u*2 - (y*(1 - mu)/earth + y*mu/moon)\nwhen y crosses 0\nend = 17.0652";

fn compare<S, const N: usize>(criterion: &mut Criterion, name: &str, system: &S, text: &str)
where
    S: ReadableSystem<N, 1, Mode = ()>,
{
    let parsed = System::parse(text).expect("a system");
    let runnable = parsed.with(&parsed.values()).expect("parameters");
    let options = Options::with_tolerance(1e-9);
    let (start, end) = (runnable.start(), runnable.end());
    let fixed = Start { mode: (), s: 0.0, state: State::from_column_slice(start.state) };
    let mut native = Vec::new();
    let first = run(Dop853, system, fixed, end, &options, &mut native).expect("a run");
    let mut other = Vec::new();
    let second = run_dynamic(Dop853, &runnable, start, end, &options, &mut other).expect("a run");
    assert_eq!(native.len(), other.len(), "{name}");
    assert!((first.state[0] - second.state[0]).abs() < 1e-5, "{name}");
    let mut group = criterion.benchmark_group(name);
    group.bench_function("native", |bencher| {
        bencher.iter(|| run(Dop853, system, black_box(fixed), end, &options, &mut ()));
    });
    group.bench_function("text", |bencher| {
        bencher.iter(|| run_dynamic(Dop853, &runnable, black_box(start), end, &options, &mut ()));
    });
    group.finish();
}

fn systems(criterion: &mut Criterion) {
    compare(criterion, "oscillator", &Oscillator, OSCILLATOR);
    compare(criterion, "kepler", &Kepler, KEPLER);
    compare(criterion, "arenstorf", &Arenstorf, ARENSTORF);
    let text = include_str!("../examples/systems/collision.slip");
    criterion.bench_function("read the collision, 50 lines", |bencher| {
        bencher.iter(|| System::parse(black_box(text)).expect("a system").with(&[18.0, 1.0, 0.1]));
    });
}

criterion_group!(benches, systems);
criterion_main!(benches);
