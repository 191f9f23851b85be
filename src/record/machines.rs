//! The machines that cases ran on: what may differ between records that are taken together, and is told.

use crate::record::whole_file::host_name;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// A machine.
#[derive(
    Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
pub struct Machine {
    /// Name of the host.
    pub node: String,
    /// Its processor, by its name where the system tells it.
    pub processor: String,
}

/// The one this program runs on.
static THIS: LazyLock<Machine> = LazyLock::new(|| {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == "model name").then(|| value.split_whitespace().collect::<Vec<_>>().join(" "))
    });
    Machine { node: host_name(), processor: name.unwrap_or_else(|| std::env::consts::ARCH.to_owned()) }
});

impl Machine {
    /// The machine that this program runs on.
    pub fn this() -> Self {
        THIS.clone()
    }
}
