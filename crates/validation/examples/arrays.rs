//! How long the collisions of an array take without Python: the yardstick of
//! `python/benches/collisions.py`, which runs it.
//!
//! Arguments: a file of little-endian doubles (all κ, then all ψ, then all dampings) and the number
//! of threads. Prints seconds: the least of five.

use std::time::Instant;

use rayon::prelude::*;
use stickslip_model::{Collision, Contact, Engine};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("a file");
    let threads = arguments.next().and_then(|text| text.parse().ok()).expect("a number");
    let bytes = std::fs::read(path).expect("the file is there");
    let numbers: Vec<f64> = bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let count = numbers.len() / 3;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let any = Collision::before(Contact::new(1.0, 1.0, 0.0).expect("in range"));
    let eps_t = |collision: &mut Collision, index: usize| {
        let [kappa, psi, damping] = [0, 1, 2].map(|column| numbers[column * count + index]);
        let contact = Contact::new(kappa, psi, damping).expect("in range");
        Engine::Exact.collide_into(contact, collision).expect("in range");
        collision.eps_t()
    };
    let once = || {
        let begun = Instant::now();
        let sum: f64 = pool.install(|| {
            (0..count).into_par_iter().map_with(any.clone(), eps_t).collect::<Vec<_>>().iter().sum()
        });
        assert!(sum.is_finite());
        begun.elapsed().as_secs_f64()
    };
    println!("{}", (0..5).map(|_| once()).fold(f64::INFINITY, f64::min));
}
