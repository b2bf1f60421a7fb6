//! Time a collision: `cargo bench --bench collisions`.
//!
//! The mean over the 200 random reference collisions is the figure to compare with other programs;
//! every group runs on one thread.

use std::hint::black_box;

use benches::contacts::{self, contacts};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use stickslip::model::regularized::{self, Phase, Regularized};
use stickslip::model::{Collider, Collision, Contact, exact};
use stickslip::solver::method::{Step, Trial};
use stickslip::solver::{
    Dop853, Guard, HybridSystem, Method, Options, Start, State, StepSize, run,
};

fn random_collisions(criterion: &mut Criterion) {
    let contacts = contacts();
    let mut group = criterion.benchmark_group("random 200");
    group.throughput(Throughput::Elements(contacts.len() as u64));
    let collider = Collider::default();
    let mut collision = Collision::before(contacts[0]);
    group.bench_function("dop853", |bencher| {
        bencher.iter(|| {
            for &contact in &contacts {
                collider.collide_into(black_box(contact), &mut collision).expect("a collision");
                black_box(collision.final_velocity);
            }
        });
    });
    for (name, contacts) in [
        ("exact, damping 0.1", contacts::damped()),
        ("exact, each with another damping", contacts::damped_differently()),
    ] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for &contact in &contacts {
                    exact::collide_into(black_box(contact), &mut collision).expect("a collision");
                    black_box(collision.final_velocity);
                }
            });
        });
    }
    group.bench_function("exact", |bencher| {
        bencher.iter(|| {
            for &contact in &contacts {
                exact::collide_into(black_box(contact), &mut collision).expect("a collision");
                black_box(collision.final_velocity);
            }
        });
    });
    group.finish();
}

/// Time against stiffness: grows as √κ, as the number of switches does.
fn stiffness(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("stiffness");
    let collider = Collider::default();
    for exponent in 0..=6 {
        let contact = Contact::new(10_f64.powi(exponent), 1.0, 0.0).expect("valid");
        let mut collision = Collision::before(contact);
        group.bench_with_input(
            BenchmarkId::new("dop853", exponent),
            &contact,
            |bencher, &contact| {
                bencher.iter(|| collider.collide_into(black_box(contact), &mut collision));
            },
        );
    }
    group.finish();
}

/// A contact that never fires a guard: the same steps with guards watched and without.
#[derive(Clone, Copy)]
struct Watched<const GUARDED: bool>(Regularized);

impl<const GUARDED: bool> HybridSystem<{ regularized::STATE }, { regularized::GUARDS }>
    for Watched<GUARDED>
{
    type Mode = Phase;

    fn field(
        &self,
        phase: Phase,
        s: f64,
        y: &State<{ regularized::STATE }>,
    ) -> State<{ regularized::STATE }> {
        self.0.field(phase, s, y)
    }

    fn step<M: Method>(
        &self,
        phase: Phase,
        trial: &Trial<'_, { regularized::STATE }>,
        step: &mut Step<{ regularized::STATE }>,
    ) {
        self.0.step::<M>(phase, trial, step);
    }

    fn guards(&self, phase: Phase) -> [Guard; regularized::GUARDS] {
        if GUARDED { self.0.guards(phase) } else { [Guard::OFF; regularized::GUARDS] }
    }

    fn guard_values(
        &self,
        phase: Phase,
        s: f64,
        y: &State<{ regularized::STATE }>,
    ) -> [f64; regularized::GUARDS] {
        if GUARDED { self.0.guard_values(phase, s, y) } else { [1.0; regularized::GUARDS] }
    }

    fn transition(
        &self,
        phase: Phase,
        guard: usize,
        s: f64,
        y: &State<{ regularized::STATE }>,
    ) -> (Phase, State<{ regularized::STATE }>) {
        self.0.transition(phase, guard, s, y)
    }
}

/// What isolation costs: one pass over the contact in slip and in stick, in equal steps, with
/// guards and without.
fn guards(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("guards");
    let contact = Contact::new(2.0, 3.0, 0.0).expect("valid");
    let options = Options { step_size: StepSize::Fixed(0.02), ..Options::default() };
    let system = Regularized::new(contact);
    let start = Start { mode: Phase::first(&contact), s: 0.0, state: system.start() };
    group.bench_function("watched", |bencher| {
        let system = Watched::<true>(system);
        bencher.iter(|| run(Dop853, &system, black_box(start), 2.5, &options, &mut ()));
    });
    group.bench_function("unwatched", |bencher| {
        let system = Watched::<false>(system);
        bencher.iter(|| run(Dop853, &system, black_box(start), 2.5, &options, &mut ()));
    });
    group.finish();
}

criterion_group!(benches, random_collisions, stiffness, guards);
criterion_main!(benches);
