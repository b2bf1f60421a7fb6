//! The program about itself: its name, its version, and what it was built from and for.

use std::sync::LazyLock;
use std::thread;

use stickslip_solver::method::FUSED_PRODUCTS;

use crate::schema;

/// The program's name.
pub const NAME: &str = "stickslip";

/// What results depend on besides the version, on one line.
pub fn build() -> String {
    let products = if FUSED_PRODUCTS { "fused" } else { "rounded" };
    format!("{}, {products} products", env!("STICKSLIP_TARGET"))
}

/// The program with what its results depend on, on one line.
pub fn program() -> String {
    format!("{NAME} {}, {}", env!("CARGO_PKG_VERSION"), build())
}

/// The text of `--version`: what a report about the program should contain.
pub fn long() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(text);
    &TEXT
}

fn text() -> String {
    let threads = thread::available_parallelism().map_or_else(|e| e.to_string(), |n| n.to_string());
    format!(
        "{}\n\
         commit     {}\n\
         built for  {}\n\
         processor  {}: {}\n\
         compiler   {}\n\
         profile    {}\n\
         threads    {threads} here\n\
         schemas    {}",
        env!("CARGO_PKG_VERSION"),
        env!("STICKSLIP_COMMIT"),
        build(),
        env!("STICKSLIP_PROCESSOR"),
        env!("STICKSLIP_FEATURES"),
        env!("STICKSLIP_COMPILER"),
        env!("STICKSLIP_PROFILE"),
        schema::ALL.join(" "),
    )
}
