//! What the benches time and count. Each bench is a file beside this folder: `cargo bench --bench
//! NAME`.

pub mod contacts;
pub mod plane;
