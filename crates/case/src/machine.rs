//! The machine that this program runs on.

use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// A machine.
#[derive(
    Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
pub struct Machine {
    /// Name of the host.
    pub node: String,
    /// Its processor, by its name if the system reports it.
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

/// Name of this machine.
pub fn host_name() -> String {
    let names = ["/proc/sys/kernel/hostname", "/etc/hostname"]
        .map(|file| std::fs::read_to_string(file).unwrap_or_default().trim().to_owned());
    let host = names.into_iter().find(|name| !name.is_empty());
    host.or_else(|| std::env::var("COMPUTERNAME").ok()).unwrap_or_else(|| "host".to_owned())
}
