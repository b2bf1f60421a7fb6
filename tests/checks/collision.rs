//! Properties of every collision, for all parameters. Tests, fuzz targets and examples share this
//! file.

use stickslip_model::exact::{self, ExactError};
use stickslip_model::{
    Collider, Collision, CollisionError, Contact, EnergyLedger, Regime, Side, Switch,
};
use stickslip_solver::Dopri5;

/// Largest unbalanced energy, in units of ψ², at the default tolerances of Dormand–Prince 8(5,3).
const BALANCE: f64 = 1e-9;
/// Largest difference of w between integrator and exact solution, in units of ψ, for springs up to
/// κ = [`SOFT`]. Beyond, it grows as √κ, like the number of steps whose errors add up.
const VELOCITY: f64 = 1e-9;
const SOFT: f64 = 1e3;
/// Largest difference of a switch time between integrator and exact solution.
const TIME: f64 = 1e-8;
/// Relative change of κ or ψ, times ψ^{2/3} for ψ < 1, that may change the switches which the
/// engines find.
const UNDECIDED: f64 = 1e-11;

/// Collides `contact` by every engine that computes it, and checks the results.
///
/// # Errors
/// A description of the first property that does not hold.
pub fn every_engine(contact: Contact) -> Result<(), String> {
    let accurate = integrated(&Collider::default(), contact)?;
    let _ = integrated(&Collider::new(Dopri5), contact)?;
    if let (Ok(integrated), Ok(closed)) = (accurate, exact(contact)?) {
        agree(&integrated, &closed).map_err(|reason| format!("{contact:?}: {reason}"))?;
    }
    Ok(())
}

/// Integrates `contact` and checks the collision, if there is one.
///
/// # Errors
/// A description of the first property that does not hold.
pub fn integrated(
    collider: &Collider,
    contact: Contact,
) -> Result<Result<Collision, CollisionError>, String> {
    let result = collider.collide(contact);
    if let Ok(collision) = &result {
        sound(collision).map_err(|reason| format!("{contact:?}: {reason}"))?;
    }
    Ok(result)
}

/// Checks that two engines found the same collision, unless a change of κ or ψ in the last digits
/// changes its switches.
///
/// # Errors
/// A description of the difference.
pub fn agree(integrated: &Collision, closed: &Collision) -> Result<(), String> {
    let contact = closed.contact;
    if integrated.itinerary() != closed.itinerary() {
        // After a small impact the last slip ends within |w| ≈ 1e-12 ψ^{1/3} of another stick
        // phase; see `docs/numerics.md`.
        let undecided = UNDECIDED * contact.psi().min(1.0).powf(-2.0 / 3.0);
        let decided = [-undecided, undecided].into_iter().all(|change| {
            let (kappa, psi) = (contact.kappa(), contact.psi());
            [(kappa * (1.0 + change), psi), (kappa, psi * (1.0 + change))].into_iter().all(
                |(kappa, psi)| {
                    let moved = Contact::new(kappa, psi, 0.0).ok().map(exact::collide);
                    moved.is_some_and(|moved| {
                        moved.is_ok_and(|moved| moved.itinerary() == closed.itinerary())
                    })
                },
            )
        });
        let (one, other) = (integrated.itinerary(), closed.itinerary());
        return require(!decided, || format!("itineraries {one} and {other}"));
    }
    let velocities = (integrated.final_velocity, closed.final_velocity);
    let bound = VELOCITY * contact.psi() * (contact.kappa() / SOFT).max(1.0).sqrt();
    require((velocities.0 - velocities.1).abs() <= bound, || format!("w = {velocities:?}"))?;
    for (one, other) in integrated.switches.iter().zip(&closed.switches) {
        require((one.time - other.time).abs() <= TIME, || format!("{one:?} and {other:?}"))?;
    }
    Ok(())
}

/// The exact solution of `contact`, checked if there is one.
///
/// # Errors
/// A description of the first property that does not hold.
pub fn exact(contact: Contact) -> Result<Result<Collision, ExactError>, String> {
    let result = exact::collide(contact);
    if let Ok(collision) = &result {
        sound(collision)
            .and_then(|()| near_misses(collision))
            .map_err(|reason| format!("exact, {contact:?}: {reason}"))?;
    }
    Ok(result)
}

/// Checks the margins of an exact collision, if it has few enough switches for them.
fn near_misses(collision: &Collision) -> Result<(), String> {
    let contact = &collision.contact;
    let Ok(margins) = exact::margins(contact) else { return Ok(()) };
    require(margins.fired == collision.fired(), || format!("{:?}", margins.fired))?;
    for (which, value) in &margins.near_misses {
        require(*value >= 0.0, || format!("{which:?} is {value:e}"))?;
        let again = exact::margin(contact, which).map_err(|error| error.to_string())?;
        let same = again.is_some_and(|again| {
            again == *value || (again - value).abs() <= 1e-9 * value.abs().max(1e-3)
        });
        require(same, || format!("{which:?} is {value:e} and {again:?}"))?;
    }
    Ok(())
}

/// Checks the properties of every collision.
fn sound(collision: &Collision) -> Result<(), String> {
    let Collision { contact, eps_n, final_velocity, contact_time, start, switches, .. } = collision;
    require(collision.eps_t().is_finite(), || format!("ε_t = {:e}", collision.eps_t()))?;
    require(contact_time.is_finite() && *contact_time > 0.0, || {
        format!("contact time {contact_time:e}")
    })?;
    let damped = contact.damping() > 0.0;
    // Without damping ε_n is 1, and v is rounded.
    require(*eps_n >= 0.0 && *eps_n <= 1.0 + 1e-11, || format!("ε_n = {eps_n:e}"))?;
    require(damped || (eps_n - 1.0).abs() <= 1e-11, || format!("ε_n = {eps_n:e} without damping"))?;
    require(final_velocity.abs() <= contact.psi() * (1.0 + 1e-9), || {
        format!("|w| has grown to {final_velocity:e}")
    })?;
    let first = if damped { Regime::Stick } else { Regime::Slip };
    require(*start == first, || format!("starts in {start}"))?;
    require(switches.len().is_multiple_of(2) != damped, || {
        format!("{} switches: {}", switches.len(), collision.itinerary())
    })?;
    in_turns(collision)?;
    in_time(switches, *contact_time)?;
    let reversed = collision.reversals % 2 == 1;
    require(*final_velocity == 0.0 || reversed == (*final_velocity < 0.0), || {
        format!("{} reversals, and w = {final_velocity:e}", collision.reversals)
    })?;
    balanced(&collision.energy, contact.psi())
}

/// Checks that regimes alternate, that slip is on the side of its switch, and that the spring is on
/// the side of its limit.
fn in_turns(collision: &Collision) -> Result<(), String> {
    let (mut regime, mut side) = (collision.start, Side::Positive);
    for (index, switch) in collision.switches.iter().enumerate() {
        let Switch { to, spring, velocity, .. } = *switch;
        let place = || format!("switch {index} of {}: {switch:?}", collision.itinerary());
        require(to != regime, place)?;
        require(to == Regime::Slip || switch.side == side, place)?;
        require(velocity.is_finite() && spring.is_finite(), place)?;
        require(switch.side.sign() * spring >= 0.0, place)?;
        (regime, side) = (to, switch.side);
    }
    require(regime == Regime::Slip, || format!("ends in {regime}"))
}

/// Checks that times rise and times left fall, both within the contact, and that their sum is the
/// contact time to rounding.
fn in_time(switches: &[Switch], contact_time: f64) -> Result<(), String> {
    let rounding = f64::EPSILON * contact_time * (switches.len() + 4) as f64;
    let (mut time, mut left) = (0.0, contact_time + rounding);
    for (index, switch) in switches.iter().enumerate() {
        let place =
            || format!("switch {index} of {}: {switch:?}, t_c {contact_time:e}", switches.len());
        require(switch.time >= time && switch.time <= contact_time, place)?;
        require(switch.time_left <= left && switch.time_left >= 0.0, place)?;
        let sum = switch.time + switch.time_left;
        require((sum - contact_time).abs() <= rounding, place)?;
        (time, left) = (switch.time, switch.time_left);
    }
    Ok(())
}

/// Checks that no energy is negative and that none is lost.
fn balanced(energy: &EnergyLedger, psi: f64) -> Result<(), String> {
    let EnergyLedger { tangential_final, spring_left, normal_final, compression_left, .. } =
        *energy;
    // The work of sliding is an impulse, which is known to 1e-16 by the rounding of v, times a
    // velocity.
    let error = BALANCE * psi * psi + 1e-15 * psi;
    let place = || format!("{energy:?}");
    require(tangential_final >= 0.0 && spring_left >= 0.0, place)?;
    require(normal_final >= 0.0 && compression_left >= 0.0, place)?;
    require(energy.sliding >= -error, place)?;
    require(energy.damping >= 0.0, place)?;
    require(energy.tangential_unbalanced().abs() <= error, place)?;
    require(energy.normal_unbalanced().abs() <= BALANCE, place)
}

fn require(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}
