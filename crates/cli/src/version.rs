//! What a report about the program should contain: what it was made from and for.

use std::sync::LazyLock;
use std::thread;

use stickslip_solver::method::FUSED_PRODUCTS;

use crate::schema;

/// What results depend on besides the version, in a line.
pub fn build() -> String {
    let products = if FUSED_PRODUCTS { "fused" } else { "rounded" };
    format!("{}, {products} products", env!("STICKSLIP_TARGET"))
}

/// The program with what its results depend on, in a line.
pub fn program() -> String {
    format!("{} {}, {}", crate::NAME, env!("CARGO_PKG_VERSION"), build())
}

/// What `--version` says.
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
