//! Whether collisions have the right switches, with every contact law. A test and an example share
//! this file.

use stickslip_model::{Contact, Damping, Engine, Law, Tolerances, exact, linear, presets};

/// Both pairs, as the command line uses them.
pub const ENGINES: [Engine; 2] =
    [Engine::Dop853(Tolerances::DOP853), Engine::Dopri5(Tolerances::DOPRI5)];

/// What the itinerary of an engine is worth.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Another opinion has the same one.
    Right,
    /// It is that of a contact so near that the tolerances do not tell the two apart.
    Near,
    /// The engine has no result, for this reason.
    Refused(String),
    /// It is not right.
    Wrong(String),
}

/// The laws of the presets that differ, and the names of the first ones that have them.
pub fn laws() -> Vec<(String, Law)> {
    let mut laws = Vec::<(String, Law)>::new();
    for limited in ["", "+limit_damping"] {
        for preset in presets::ALL {
            let name = format!("{}{limited}", preset.name);
            let law = presets::find(&name).expect("a preset").law;
            if laws.iter().all(|(_, other)| *other != law) && (limited.is_empty() || limits(law)) {
                laws.push((name, law));
            }
        }
    }
    laws
}

/// Whether the normal force would attract if it were not limited.
fn limits(law: Law) -> bool {
    law.endless_from().is_finite() || law.damping != Damping::None && law != Law::PAPER
}

/// Random contacts, at most `count` of them. The second half is beside one boundary, where phases
/// are short: to find it takes as long as to judge many contacts beside it.
///
/// κ is log-uniform from 1 to `stiffest`, ψ from 1e-3 to 3, the damping from 1e-10 to 10 (or to
/// that with which contacts never end), and in one of eight contacts 0. Every second damped contact
/// has a tangential damping from 0 to 2.
pub fn random(law: Law, stiffest: f64, count: usize, random: &mut fastrand::Rng) -> Vec<Contact> {
    let few = count.div_ceil(2);
    let mut contacts: Vec<_> = (0..few).map(|_| anywhere(law, stiffest, random)).collect();
    contacts.extend(beside_boundary(contacts[0], count - few, random));
    contacts
}

/// Contacts with another ψ, up to 1e-12 to 0.1 of it from the nearest change of the itinerary that
/// a bisection finds; the same contact if it finds none.
fn beside_boundary(contact: Contact, count: usize, random: &mut fastrand::Rng) -> Vec<Contact> {
    let engine = if has_exact(&contact) { Engine::Exact } else { ENGINES[0] };
    let with = |psi: f64| {
        let other = Contact::new(contact.kappa(), psi, contact.damping());
        other.and_then(|it| it.with_law(contact.law(), contact.tangential_damping()))
    };
    let itinerary = |psi: f64| Some(engine.collide(with(psi).ok()?).ok()?.0.itinerary());
    let here = itinerary(contact.psi());
    let (mut same, mut other) = (contact.psi(), contact.psi() * 4.0_f64.powf(random.f64() - 0.5));
    if itinerary(other) == here {
        return vec![contact];
    }
    for _ in 0..50 {
        let middle = 0.5 * (same + other);
        *(if itinerary(middle) == here { &mut same } else { &mut other }) = middle;
    }
    let mut beside = || {
        let away = 10.0_f64.powf(-1.0 - 11.0 * random.f64());
        with(same * if random.bool() { 1.0 + away } else { 1.0 - away }).unwrap_or(contact)
    };
    (0..count).map(|_| beside()).collect()
}

/// Whether there is an exact solution.
fn has_exact(contact: &Contact) -> bool {
    contact.obeys_paper() || linear::solves(contact)
}

fn anywhere(law: Law, stiffest: f64, random: &mut fastrand::Rng) -> Contact {
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let (kappa, psi) = (between(1.0, stiffest), between(1e-3, 3.0));
    let damping = between(1e-10, (0.99 * law.endless_from()).min(10.0));
    let none = law.damping == Damping::None || random.u8(..) < 32;
    let damping = if none { 0.0 } else { damping };
    let even = law == Law::PAPER || law.damping.is_hysteretic() || random.bool();
    let tangential_damping = if even { 0.0 } else { 2.0 * random.f64() };
    Contact::new(kappa, psi, damping)
        .and_then(|contact| contact.with_law(law, tangential_damping))
        .expect("parameters in range")
}

/// Judges the itineraries of `contact` by both [`ENGINES`].
///
/// The second opinion is an exact solution if there is one. Otherwise it is the other pair, which
/// takes other steps; where both differ, 5(4) with a tolerance of 1e-12 is the opinion about
/// 8(5,3).
pub fn judged(contact: Contact) -> [Verdict; 2] {
    let found = ENGINES.map(|engine| Itinerary::of(engine, contact));
    let exact = has_exact(&contact).then(|| Itinerary::of(Engine::Exact, contact));
    [0, 1].map(|which| {
        let own = match &found[which] {
            Ok(own) => own,
            Err(reason) => return Verdict::Refused(reason.clone()),
        };
        let finer = Engine::Dopri5(Tolerances { rtol: 1e-12, atol: 1e-12 });
        let others = exact.as_ref().unwrap_or(&found[1 - which]);
        match others {
            Ok(other) if other.letters == own.letters => Verdict::Right,
            _ if exact.is_some() => own.verdict(contact, (ENGINES[which], Engine::Exact), others),
            _ if which == 0 => {
                own.verdict(contact, (ENGINES[0], finer), &Itinerary::of(finer, contact))
            }
            _ => own.verdict(contact, (ENGINES[1], ENGINES[0]), others),
        }
    })
}

/// What an engine finds.
struct Itinerary {
    letters: String,
    /// The springs at the switches.
    springs: Vec<f64>,
}

impl Itinerary {
    fn of(engine: Engine, contact: Contact) -> Result<Self, String> {
        let (collision, _) = engine.collide(contact).map_err(|error| error.to_string())?;
        let springs = collision.switches.iter().map(|switch| switch.spring).collect();
        Ok(Self { letters: collision.itinerary(), springs })
    }

    /// The verdict about this itinerary of an engine, where that of a `second` one is `expected`.
    fn verdict(
        &self,
        contact: Contact,
        (engine, second): (Engine, Engine),
        expected: &Result<Self, String>,
    ) -> Verdict {
        match expected {
            Ok(expected) if expected.letters == self.letters => Verdict::Right,
            Ok(expected) => self.differs(contact, (engine, second), &expected.letters),
            Err(error) => Verdict::Refused(format!("no second opinion: {error}")),
        }
    }

    fn differs(
        &self,
        contact: Contact,
        (engine, second): (Engine, Engine),
        expected: &str,
    ) -> Verdict {
        let coarsest = [engine, second].into_iter().filter_map(|it| it.tolerances());
        let tolerance = coarsest.fold(0.0, |largest: f64, it| largest.max(it.atol));
        let (found, springs) = (&self.letters, &self.springs);
        let pairs = found.bytes().zip(expected.bytes());
        let same = pairs.take_while(|(one, other)| one == other).count();
        // The first letter is of the start, the next ones are of the switches.
        let differs = springs.get(same.saturating_sub(1).min(springs.len().saturating_sub(1)));
        let shorter = differs.is_some_and(|spring| spring.abs() < tolerance);
        let near = if shorter && !has_exact(&contact) {
            // Tolerances do not resolve such a spring.
            true
        } else if contact.obeys_paper() {
            exact::distance(&contact).is_ok_and(|distance| distance < 100.0 * tolerance)
        } else {
            // A change of a parameter may move the nearest boundary less than an error within the
            // run. Contacts beside are asked of the second opinion alone: the engine may be wrong
            // at random.
            let has_found =
                |beside| Self::of(second, beside).is_ok_and(|other| other.letters == self.letters);
            beside(contact, 1e4 * tolerance).any(has_found)
        };
        if near { Verdict::Near } else { Verdict::Wrong(format!("{found}, not {expected}")) }
    }
}

/// Contacts that differ in one parameter, by up to `most` of it.
fn beside(contact: Contact, most: f64) -> impl Iterator<Item = Contact> {
    let changes = (0..).map(|k| 1e-15 * 10.0_f64.powi(k)).take_while(move |change| *change <= most);
    let which = (0..4).flat_map(|which| [(which, 1.0), (which, -1.0)]);
    changes.flat_map(move |change| which.clone().map(move |it| (it, change))).filter_map(
        move |((which, sign), change)| {
            let part = |of: i32| if of == which { 1.0 + sign * change } else { 1.0 };
            let (kappa, psi) = (contact.kappa() * part(0), contact.psi() * part(1));
            let damping = contact.damping() * part(2);
            let tangential = contact.tangential_damping() * part(3);
            let beside = Contact::new(kappa, psi, damping);
            beside.and_then(|beside| beside.with_law(contact.law(), tangential)).ok()
        },
    )
}
