//! Laws that every exact collision obeys. `tests/model/exact.rs` compares with reference data.

use std::f64::consts::PI;

use super::moment::{Half, Motion};
use super::*;

fn exact(kappa: f64, psi: f64) -> Collision {
    collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap()
}

#[test]
fn pure_sliding_starts_where_the_closed_form_says() {
    let tops =
        [(0.1, 10.4779732741472), (0.3, 3.6107667429891), (0.6, 2.0), (18.0, 2.0), (1e6, 2.0)];
    for (kappa, top) in tops {
        assert!(exact(kappa, top * (1.0 - 1e-13)).switches.len() >= 2, "{kappa}");
        let sliding = exact(kappa, top * (1.0 + 1e-13));
        assert!(sliding.switches.is_empty(), "{kappa}");
        assert!((sliding.eps_t() - (1.0 - 2.0 / sliding.contact.psi())).abs() < 1e-15);
    }
    assert_eq!(exact(18.0, 2.0).switches.len(), 0);
}

#[test]
fn stiff_springs_leave_a_velocity_of_order_kappa_to_minus_five_quarters() {
    let largest = |kappa: f64| {
        (0..400)
            .map(|i| exact(kappa * (1.0 + 1e-4 * f64::from(i)), 1.0))
            .map(|collision| collision.final_velocity.abs() * collision.contact.kappa().powf(1.25))
            .fold(0.0, f64::max)
    };
    assert!((largest(1e5) - 4.4841).abs() < 2e-3, "{}", largest(1e5));
    assert!((largest(1e7) - 4.484).abs() < 4e-3, "{}", largest(1e7));
}

/// Numbers between 0 and 1 by xorshift64, the same on every machine.
fn randoms() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        f64::from((state >> 32) as u32) / f64::from(u32::MAX)
    }
}

/// Random contacts, `count` of them, with log₁₀ κ and log₁₀ ψ in these ranges.
fn contacts(count: usize, kappa: (f64, f64), psi: (f64, f64)) -> impl Iterator<Item = Contact> {
    let mut random = randoms();
    let mut draw = move |(low, high): (f64, f64)| 10_f64.powf(low + (high - low) * random());
    std::iter::repeat_with(move || {
        let kappa = draw(kappa);
        Contact::new(kappa, draw(psi), 0.0).unwrap()
    })
    .take(count)
}

#[test]
fn every_collision_is_finite_ordered_even_and_balanced() {
    let sets = [
        (40_000, (-12.0, 5.0), (-12.0, 12.0), 1e-11),
        (40_000, (-2.0, 4.0), (-3.0, 0.4), 1e-13),
        (40_000, (0.0, 0.4), (-1.0, 0.4), 1e-14),
        (400, (5.0, 8.0), (-12.0, 1.0), 1e-10),
        (4, (8.0, 12.0), (-6.0, 0.4), 1e-12),
    ];
    for (count, kappa, psi, balance) in sets {
        for contact in contacts(count, kappa, psi) {
            let collision = collide(contact).unwrap();
            let switches = &collision.switches;
            assert!(switches.len().is_multiple_of(2), "{contact:?}");
            assert!(collision.final_velocity.is_finite(), "{contact:?}");
            for (index, switch) in switches.iter().enumerate() {
                let to = if index.is_multiple_of(2) { Regime::Stick } else { Regime::Slip };
                assert_eq!(switch.to, to, "{contact:?}");
                let numbers = [switch.time, switch.time_left, switch.spring, switch.velocity];
                assert!(numbers.iter().all(|number| number.is_finite()), "{contact:?}");
                assert!(switch.time > 0.0 && switch.time_left > 0.0, "{contact:?}");
            }
            for pair in switches.windows(2) {
                assert!(pair[0].time <= pair[1].time, "{contact:?}");
                assert!(pair[0].time_left >= pair[1].time_left, "{contact:?}");
            }
            let ledger = collision.energy;
            let lost = ledger.tangential_unbalanced().abs() / ledger.tangential_initial;
            assert!(lost < balance, "{contact:?}: {lost}");
            assert_eq!(ledger.normal_unbalanced(), 0.0);
            let reversed = collision.final_velocity < 0.0;
            assert_eq!(collision.reversals % 2 == 1, reversed, "{contact:?}");
        }
    }
}

/// The moment of a switch, from its times.
fn moment<T: Trajectory>(path: &T, switch: &Switch) -> Moment {
    let unit = path.time_unit();
    if switch.time < switch.time_left {
        path.after(&path.at(Moment::START), switch.time / unit, 0.0)
    } else {
        path.before(&path.at(Moment::END), switch.time_left / unit, 0.0)
    }
}

/// Moments between `from` and `to`, which divide the root coordinate into `count` equal parts.
fn moments<T: Trajectory>(
    path: &T,
    from: Moment,
    to: Moment,
    count: u32,
) -> impl Iterator<Item = Moment> {
    let [early, late] = path.middle();
    let place = |moment: Moment| match moment.half {
        Half::Compression => moment.root,
        Half::Decompression => early + late - moment.root,
    };
    let (low, high) = (place(from), place(to));
    (1..count).map(move |i| {
        let at = low + (high - low) * f64::from(i) / f64::from(count);
        if at < early {
            Moment { half: Half::Compression, root: at }
        } else {
            Moment { half: Half::Decompression, root: early + late - at }
        }
    })
}

/// Follows a collision as reported, and checks the law of each phase inside it and at its end.
/// Returns the number of sign changes of w on the way.
fn audit(collision: &Collision) -> usize {
    with_trajectory(&collision.contact, Audit(collision))
}

struct Audit<'c>(&'c Collision);

impl Task for Audit<'_> {
    type Output = usize;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small, positive")]
    fn run<T: Trajectory>(self, slide: &Slide<T>, contact: &Contact) -> usize {
        let (path, spring) = (slide.path, slide.spring);
        let tolerance = 2e-13 * contact.psi().max(1.0);
        let mut velocities = vec![contact.psi()];
        let mut phase = Phase::first(slide, contact.psi());
        let mut side = 1.0;
        let mut switches = self.0.switches.iter();
        loop {
            phase = match phase {
                Phase::Slip(sliding) => {
                    let switch = switches.next();
                    let end = switch.map_or(Moment::END, |switch| moment(path, switch));
                    for at in moments(path, sliding.start, end, 200) {
                        let at = path.at(at);
                        velocities.push(side * sliding.velocity_at(&at).0);
                        let guard = slide.guard(&sliding, &at);
                        assert!(guard > -tolerance, "{contact:?}: missed stick, {guard} at {at:?}");
                    }
                    if switch.is_none() {
                        break;
                    }
                    let onset = path.at(end);
                    let velocity = sliding.velocity_at(&onset);
                    let guard = slide.guard(&sliding, &onset);
                    assert!(guard.abs() < tolerance, "{contact:?}: invented stick, {guard}");
                    velocities.push(side * velocity.0);
                    Phase::Stick(Swing::new(slide, onset, velocity))
                }
                Phase::Stick(swing) => {
                    let switch = switches.next().expect("a stick phase ends");
                    let end = moment(path, switch);
                    let release = path.at(end);
                    let angle = spring.omega * swing.elapsed(&release);
                    // With damping, w is followed through both halves of the contact.
                    let rounding = if T::STARTS_IN_SLIP { 0.0 } else { contact.psi() };
                    let amplitude = swing.amplitude * (4.0 + angle) + rounding / spring.omega;
                    let tolerance = 1e-15 * amplitude;
                    let count = 100 + 50 * (angle / PI) as u32;
                    for at in moments(path, swing.start.moment, end, count) {
                        let at = path.at(at);
                        let gap = swing.gap(0, &at);
                        velocities.push(side * gap.q_rate);
                        let other = slide.limit(&at) + gap.q;
                        assert!(gap.value > -tolerance, "{contact:?}: missed slip, {gap:?}");
                        assert!(other > -tolerance, "{contact:?}: missed slip, {other}");
                    }
                    let gap = swing.gap(0, &release);
                    let exit = switch.side.sign();
                    let off = (exit * side * gap.q - slide.limit(&release)).abs();
                    assert!(off < tolerance, "{contact:?}: invented slip, {off} at {release:?}");
                    let outward = exit * side * gap.q_rate - release.motion.limit_rate(&spring);
                    let least = -2e-13 * contact.psi().max(1.0);
                    assert!(outward > least, "{contact:?}: {outward} at {release:?}");
                    velocities.push(side * gap.q_rate);
                    side = exit;
                    Phase::Slip(SlipPhase::new(path.impulse(), &release, exit * switch.velocity))
                }
            };
        }
        velocities.push(self.0.final_velocity);
        velocities.windows(2).filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0)).count()
    }
}

#[test]
fn each_phase_keeps_its_law_from_switch_to_switch() {
    let sets = [
        (1500, (-6.0, 4.0), (-4.0, 1.0)),
        (1500, (-1.0, 3.0), (-2.0, 0.35)),
        (1500, (-0.7, 0.3), (-0.3, 0.8)),
        (500, (0.19, 0.2), (-0.3, 0.35)),
    ];
    for (count, kappa, psi) in sets {
        for contact in contacts(count, kappa, psi) {
            let collision = collide(contact).unwrap();
            assert_eq!(audit(&collision), collision.reversals, "{contact:?}");
        }
    }
}

#[test]
fn each_damped_phase_keeps_its_law_from_switch_to_switch() {
    let sets = [
        ((-6.0, 4.0), (-4.0, 1.0), (-6.0, 4.0)),
        ((-1.0, 3.0), (-2.0, 0.35), (-3.0, 1.0)),
        ((-0.7, 0.3), (-0.3, 0.8), (-3.0, -0.2)),
        ((0.1, 0.3), (-0.3, 0.35), (-1.5, -0.2)),
    ];
    for (kappa, psi, damping) in sets {
        let mut random = randoms();
        let mut draw = |(low, high): (f64, f64)| 10_f64.powf(low + (high - low) * random());
        for _ in 0..1000 {
            let contact = Contact::new(draw(kappa), draw(psi), draw(damping)).unwrap();
            let collision = collide(contact).unwrap();
            assert_eq!(audit(&collision), collision.reversals, "{contact:?}");
        }
    }
}

#[test]
fn the_ends_of_the_number_range_are_survived() {
    let smallest = f64::MIN_POSITIVE * f64::EPSILON;
    for kappa in [smallest, 1e-308, 1e-200, 1e-20, 1.568_459_328_886_909_8, 1e13, 1e300] {
        for psi in [smallest, 1e-300, 1e-100, 1e-12, 2.0, 1e100, 1e300] {
            match collide(Contact::new(kappa, psi, 0.0).unwrap()) {
                Ok(collision) => assert!(collision.eps_t().abs() <= 1.0, "{kappa} {psi}"),
                Err(error) => {
                    let inside = |x: f64, most: f64| (1e-100..=most).contains(&x);
                    assert!(!inside(kappa, 1e16) || !inside(psi, 1e100), "{kappa} {psi}: {error}");
                }
            }
        }
    }
}

#[test]
fn results_do_not_depend_on_the_thread() {
    let sweep = || contacts(300, (-2.0, 3.0), (-3.0, 0.4)).map(collide).collect::<Vec<_>>();
    let here = sweep();
    let threads = [(); 2].map(|()| std::thread::spawn(sweep));
    for thread in threads {
        assert_eq!(thread.join().unwrap(), here);
    }
}

#[test]
fn refusals_carry_their_numbers() {
    let strong = Contact::new(18.0, 1.0, 2e4).unwrap();
    let Err(ExactError::Domain(beyond)) = collide(strong) else { panic!("a = 2e4 was accepted") };
    assert_eq!((beyond.quantity, beyond.value, beyond.most), ("damping", 2e4, 1e4));
    let stiff = Contact::new(2e16, 1.0, 0.0).unwrap();
    let Err(ExactError::Domain(beyond)) = collide(stiff) else { panic!("κ = 2e16 was accepted") };
    assert_eq!((beyond.quantity, beyond.value, beyond.most), ("kappa", 2e16, 1e16));
    let contact = Contact::new(63.0, 1.0, 0.0).unwrap();
    let count = exact(63.0, 1.0).switches.len();
    let mut collision = Collision::before(contact);
    assert!(collide_within(contact, &mut collision, count).is_ok());
    let refused = collide_within(contact, &mut collision, count - 1).unwrap_err();
    let ExactError::TooManySwitches { limit, kappa, psi, time_left } = refused else {
        panic!("{refused}")
    };
    assert_eq!((limit, kappa, psi), (count - 1, 63.0, 1.0));
    assert_eq!(time_left, exact(63.0, 1.0).switches[count - 2].time_left);
}

#[test]
#[should_panic(expected = "missed stick")]
fn the_audit_sees_a_missing_pair() {
    let mut collision = exact(63.0, 1.0);
    collision.switches.truncate(collision.switches.len() - 2);
    audit(&collision);
}

#[test]
#[should_panic(expected = "missed slip")]
fn the_audit_sees_a_late_switch() {
    let mut collision = exact(63.0, 1.0);
    let first = &mut collision.switches[1];
    first.time += 0.05;
    first.time_left -= 0.05;
    audit(&collision);
}

/// κ and ψ at a relative distance of 1e-6, 1e-9 or 1e-10 below a slip graze, and the times of the
/// first two switches, computed with 40 digits from the closed form.
const SLIP_GRAZES: [(f64, f64, f64, f64); 6] = [
    (0.2, 5.324485084798437, 0.73301009509621493916, 0.73303659202271994763),
    (0.7, 1.6748688531396472, 0.86482996032894687174, 0.86492858482875625191),
    (0.7, 1.6748688546470292, 0.86485243915692781413, 0.86488362694773545709),
    (1.3, 1.0696020112277536, 1.1593437527291455836, 1.1593884002547941003),
    (1.5, 1.008088025882126, 1.3732511095767852613, 1.379704609014040322),
    (1.5, 1.0080890338703512, 1.3753762935733874188, 1.3754407836991174155),
];

#[test]
fn short_phases_beside_slip_grazes_keep_their_digits() {
    for (kappa, psi, stick, slip) in SLIP_GRAZES {
        let switches = exact(kappa, psi).switches;
        assert!((switches[0].time - stick).abs() < 1e-15, "{kappa} {psi}");
        assert!((switches[1].time - slip).abs() < 4e-15, "{kappa} {psi}");
    }
}

/// The last half swing of a stick phase ends with the contact, within rounding: the spring and its
/// limit vanish together, and the phase ends before that.
#[test]
fn a_half_swing_that_ends_with_the_contact() {
    // κ, ψ, damping, and ε_t with 15 digits, from series with 60 digits (tests/data/README.md).
    for (kappa, psi, damping, expected) in [
        (9.10861736788427_f64, 0.08338591833869062, 0.15980234487731435, -0.815827184943248),
        (10.55781673943056, 0.0445066032235727, 0.6133306067792448, -0.922265028521188),
        (41.91443754977041, 0.010975119883917863, 0.587818608535903, 0.897419709840706),
        (8.647982381711758, 0.03394040446067769, 0.019138307299234297, -0.9959537571763449),
    ] {
        for ulps in -8..=8_i64 {
            let kappa = f64::from_bits(kappa.to_bits().wrapping_add_signed(ulps));
            let found = collide(Contact::new(kappa, psi, damping).unwrap()).unwrap();
            assert!((found.eps_t() - expected).abs() < 1e-13, "{kappa} {psi} {}", found.eps_t());
        }
    }
}
