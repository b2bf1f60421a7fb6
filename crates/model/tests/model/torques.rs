//! Where a single impact feels rolling and twisting friction, and where not.
//!
//! Both are torques beside the force at the contact. They are stepped here in the plane of an
//! impact: spheres of radius and mass 1 with J = 2/5, a linear normal force without damping, a
//! tangential spring, and a rolling torque of the size μ_r F R against the relative spin.

use std::f64::consts::PI;

/// What a rolling impact leaves: the tangential velocity of the surfaces, and the spins.
struct Rolled {
    slip: f64,
    spins: [f64; 2],
}

const INERTIA: f64 = 0.4;
const FRICTION: f64 = 0.3;

/// A sphere with the velocities (1, g) towards another sphere that does not move but may spin, or a
/// wall.
fn impact(tangential: f64, rolling: f64, wall: bool, spins: [f64; 2]) -> Rolled {
    let dt = PI / 40_000.0;
    // The mass of the second body, and whether it turns.
    let second = if wall { 0.0 } else { 1.0 };
    let (mut x, mut approach, mut y) = (0.0, 1.0, 0.0);
    let (mut velocity, mut spins) = (tangential, spins);
    let stiffness = 3.0;
    loop {
        let slip = velocity + spins[0] + second * spins[1];
        x += dt * approach;
        if x <= 0.0 && approach < 0.0 {
            return Rolled { slip, spins };
        }
        y += dt * slip;
        let limit = FRICTION * x;
        let pull = (stiffness * y).clamp(-limit, limit);
        y = pull / stiffness;
        // LAMMPS' rolling spring is far stiffer than this contact lasts: its limit acts.
        let relative = spins[0] - second * spins[1];
        let torque = rolling * x * if relative == 0.0 { 0.0 } else { relative.signum() };
        approach -= dt * x * (1.0 + second);
        velocity -= dt * pull * (1.0 + second);
        spins[0] -= dt * (pull + torque) / INERTIA;
        spins[1] -= dt * second * (pull - torque) / INERTIA;
    }
}

/// Two equal spheres without spin turn alike, so that nothing rolls: the torque, whose sign is that
/// of the relative spin, is 0. Where one spins before, it changes the difference of the spins and
/// not their sum, which is in the velocity of the surfaces.
#[test]
fn equal_spheres_feel_no_rolling_friction_in_eps_t() {
    for tangential in [0.1, 0.5, 3.0] {
        let of = |rolling, spins| impact(tangential, rolling, false, spins);
        let [without, with] = [0.0, 0.1].map(|rolling| of(rolling, [0.0; 2]));
        assert_eq!(without.slip.to_bits(), with.slip.to_bits());
        assert_eq!(without.spins[0].to_bits(), with.spins[0].to_bits());
        assert_eq!(without.spins[0], without.spins[1]);
        let [without, with] = [0.0, 0.01].map(|rolling| of(rolling, [2.0, -1.5]));
        assert!((without.slip - with.slip).abs() < 1e-10);
        // The impulse is 1, and the torque acts against 3.5 for as long as the contact lasts.
        let change = without.spins[0] - with.spins[0];
        assert!((change - 0.01 / INERTIA).abs() < 1e-4, "{change}");
    }
}

/// A sphere on a wall rolls: in gross sliding ε_t falls by less, by the part μ_r/μ of what sliding
/// does to the spin, and with the μ_r of grains, some 0.01, by a few hundredths at most.
#[test]
fn a_wall_feels_rolling_friction_by_its_part_of_the_spin() {
    for rolling in [0.003, 0.01, 0.03] {
        for tangential in [4.0, 8.0] {
            let [without, with] =
                [0.0, rolling].map(|rolling| impact(tangential, rolling, true, [0.0; 2]));
            // The impulse is 2, the spin −2μ/J, and torque against it +2μ_r/J.
            let spin = -2.0 * FRICTION / INERTIA;
            assert!((without.spins[0] - spin).abs() < 1e-3, "{}", without.spins[0]);
            let part = (with.spins[0] - without.spins[0]) / -spin;
            assert!((part - rolling / FRICTION).abs() < 2e-3, "{part}");
            let change = (with.slip - without.slip) / tangential;
            let expected = 2.0 * rolling / INERTIA / tangential;
            assert!((change - expected).abs() < 1e-3, "{change} {expected}");
        }
    }
    // At μ_r = 0.01 and g_t/g_n = 4 that is 0.0125 in ε_t.
    let [without, with] = [0.0, 0.01].map(|rolling| impact(4.0, rolling, true, [0.0; 2]));
    assert!(((with.slip - without.slip) / 4.0 - 0.0125).abs() < 5e-4);
}
