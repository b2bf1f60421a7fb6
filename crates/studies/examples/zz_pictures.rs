//! Throwaway.
use std::{fs, path::Path};
use stickslip_figure::{Svg, pictures, png};
use stickslip_model::*;
use stickslip_plane::atlas::*;
use stickslip_plane::progress::SILENT;
use stickslip_plane::*;
use stickslip_studies::figures::Reproduction;
use stickslip_studies::statements::Spring;
use stickslip_studies::{Study, convergence, stiff_springs};
fn put(dir: &Path, name: &str, svg: &Svg) {
    fs::write(dir.join(format!("{name}.svg")), svg.document()).unwrap();
    fs::write(dir.join(format!("{name}.png")), png(svg).unwrap()).unwrap();
}
fn write(dir: &Path, prefix: &str, study: &Study) {
    for p in &study.pictures {
        put(dir, &format!("{prefix}{}", p.name), &p.svg);
    }
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let dir = Path::new(&args[1]);
    fs::create_dir_all(dir).unwrap();
    for (name, k, p, a) in [
        ("c1", 63.0, 0.5, 0.0),
        ("c2", 38.0, 0.7, 0.3),
        ("c3", 5.0, 1e6, 0.0),
        ("c4", 1e4, 0.5, 0.0),
    ] {
        let contact = Contact::new(k, p, a).unwrap();
        let c = Collider::default().collide(contact).unwrap();
        let h = Collider::default().history(contact).unwrap();
        put(dir, name, &pictures::collision::draw(&c, &h));
    }
    let axis = |low, high, cells| GridAxis { range: Range { low, high }, cells };
    for (name, x, y, damping) in [
        ("m1", axis(0.0, 70.0, 120), axis(0.0, 2.9, 90), 0.0),
        ("m2", axis(0.0, 20.0, 120), axis(0.0, 3.0, 90), 0.1),
        ("m3", axis(300.0, 400.0, 120), axis(0.1, 0.2, 90), 0.0),
        ("m4", axis(0.0, 5.0, 50), axis(2.5, 10.0, 50), 0.0),
    ] {
        let grid = Grid { columns: x, rows: y, coordinates: Coordinates::Psi { damping } };
        let tile = sweep::compute(&grid, Engine::Auto, 0..grid.points());
        put(dir, name, &pictures::grid::draw(&grid, (x.cells, y.cells), &tile).unwrap());
    }
    for (name, kappa, psi, damping) in [
        ("t1", (5.0, 100.0), (0.05, 3.0), 0.0),
        ("t2", (5.0, 20.0), (0.2, 2.5), 0.05),
        ("t3", (0.05, 100.0), (0.01, 3.0), 0.0),
        ("t4", (5.0, 8.0), (0.8, 1.2), 0.0),
        ("t5", (5.0, 8.0), (2.5, 3.0), 0.0),
    ] {
        let r = |(low, high)| Range { low, high };
        let frame = Frame { kappa: r(kappa), psi: r(psi), ratio: None, damping };
        let v = trace(frame, frame.tolerances().usual, SILENT).unwrap();
        put(dir, name, &pictures::atlas::draw(&v.atlas));
    }
    if args.len() > 2 {
        return;
    }
    let r = Reproduction::new(120, Spring::Reset);
    for part in Reproduction::parts() {
        if part.title.to_lowercase().contains("statement") {
            continue;
        }
        let section = part.run(&r).unwrap();
        eprintln!("{} {:?}", part.title, section.objections);
        write(dir, "r_", &section.study);
    }
    let c = convergence::Settings {
        contacts: vec![stickslip_model::Contact::new(1000.0, 0.5, 0.0).unwrap()],
    };
    write(dir, "v02_", &convergence::run(&c, SILENT).unwrap());
    write(
        dir,
        "v03_",
        &convergence::run(&convergence::Settings::usual(0.1).unwrap(), SILENT).unwrap(),
    );
    let s = stiff_springs::Settings {
        kappa: stickslip_plane::Range { low: 1e3, high: 1e6 },
        psi: vec![0.1, 0.5, 1.9],
    };
    write(dir, "a02_", &stiff_springs::run(&s, SILENT).unwrap());
}
