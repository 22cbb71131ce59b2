//! All Rust of the program as one library. Each part has its own C interface, beside its crate.

pub use {bus_master, mcap_sink};
