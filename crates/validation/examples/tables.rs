//! Draft.
use std::error::Error;
use std::time::Instant;
use stickslip::plane::{Range, progress};
use stickslip_practice::tables::{self, Settings};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let g = |i: usize, d: f64| args.get(i).copied().unwrap_or(d);
    let settings = Settings {
        bound: g(0, 1e-8),
        kappa: Range { low: g(1, 0.5), high: g(2, 100.0) },
        psi: Range { low: g(3, 0.01), high: g(4, 3.0) },
        damping: g(5, 0.0),
        regions: true,
    };
    let start = Instant::now();
    let table = tables::run(&settings, progress::SILENT)?;
    println!(
        "{:?} bytes {} slabs, strips {:?} rows {}",
        start.elapsed(),
        table.bytes(),
        table.pieces(),
        table.arrays().rows.len() / 12
    );
    println!("{:?} regions {}", table.verification, table.regions.len());
    if g(6, 0.0) > 0.0 {
        stats(&table);
    }
    let n = 4_000_000;
    let points: Vec<[f64; 2]> = (0..n)
        .map(|_| {
            [
                (g(1, 0.5).ln() + fastrand::f64() * (g(2, 100.0) / g(1, 0.5)).ln()).exp(),
                g(3, 0.01) + fastrand::f64() * (g(4, 3.0) - g(3, 0.01)),
            ]
        })
        .collect();
    let start = Instant::now();
    let mut sum = 0.0;
    for p in &points {
        sum += table.eps_t(p[0], p[1]);
    }
    println!("{} ns {sum}", start.elapsed().as_nanos() as f64 / n as f64);
    if g(7, 0.0) > 0.0 {
        return Ok(());
    }
    let best = |f: &dyn Fn(f64, f64) -> f64| {
        points
            .chunks(1000)
            .take(1000)
            .map(|chunk| {
                let start = Instant::now();
                let sum: f64 = chunk.iter().map(|p| f(p[0], p[1])).sum();
                std::hint::black_box(sum);
                start.elapsed().as_nanos() as f64 / 1000.0
            })
            .fold(f64::INFINITY, f64::min)
    };
    println!("best {}", best(&|k, p| table.eps_t(k, p)));
    let header = table.c_header("stickslip")?;
    println!("header {}", header.len());
    std::fs::write("/tmp/hw/table.h", header)?;
    let mut text = String::new();
    for p in &points[..100000] {
        text += &format!(
            "{:?} {:?} {:?} {}\n",
            p[0],
            p[1],
            table.eps_t(p[0], p[1]),
            table.region(p[0], p[1]).map_or(-1, |r| r as i64)
        );
    }
    std::fs::write("/tmp/hw/points.txt", text)?;
    for chunk in [100, 100, 1000, 1000] {
        let start = Instant::now();
        for _ in 0..n / chunk {
            for p in &points[..chunk] {
                sum += table.eps_t(p[0], p[1]);
            }
        }
        println!("{chunk}: {} ns {sum}", start.elapsed().as_nanos() as f64 / n as f64);
    }
    Ok(())
}
fn stats(table: &tables::Table) {
    let a = table.arrays();
    for slab in 0..a.scales.len() {
        let (f, l) = (a.first_strips[slab] as usize, a.first_strips[slab + 1] as usize);
        let counts: Vec<String> = (f..l - 1)
            .map(|s| {
                format!(
                    "{}{}",
                    a.first_rows[s + 1] - a.first_rows[s],
                    ["", "L", "H"][a.strip_stretches[s] as usize]
                )
            })
            .collect();
        println!(
            "{:.5} {:.3e} {:?} {} [{}]",
            a.walls[slab],
            a.walls[slab + 1] - a.walls[slab],
            a.slab_stretches[slab],
            counts.len(),
            counts.join(" ")
        );
    }
}
