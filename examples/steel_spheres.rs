//! Every switch, in SI units, of a collision of the steel spheres of Schwager, Becker and Pöschel
//! (2008), Fig. 2.
//!
//! Run with `cargo run --release --example steel_spheres`.

use stickslip::model::Collider;
use stickslip::model::spheres::{BodyPair, Material, Surface};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };
    let impact = BodyPair::equal_spheres(0.02, &steel, &surface)?.impact(20.0, 4.0)?;
    let collision = Collider::default().collide(impact.contact)?;

    println!("κ = {}, ψ = {}", impact.contact.kappa(), impact.contact.psi());
    println!("contact lasts {:.6e} s", collision.contact_time * impact.time_unit_s);
    println!(
        "{:>16} {:>6} {:>5} {:>16} {:>16}",
        "time [s]", "to", "side", "spring [m]", "velocity [m/s]"
    );
    for switch in &collision.switches {
        println!(
            "{:>16.9e} {:>6} {:>+5} {:>16.6e} {:>16.6e}",
            switch.time * impact.time_unit_s,
            switch.to.to_string(),
            switch.side.sign(),
            impact.spring_m(switch.spring),
            impact.velocity_m_per_s(switch.velocity),
        );
    }
    println!("ε_n = {}, ε_t = {}", collision.eps_n, collision.eps_t());
    Ok(())
}

#[test]
fn it_holds() {
    main().expect("what it shows");
}
