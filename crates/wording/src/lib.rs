//! How numbers, times and names of choices are written and said, the same in every sentence, table and file. Knows no mechanics.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod choices;
mod numbers;
mod times;

pub use choices::is_default;
pub use numbers::{count_of, first_few, order, orders, rounded, typed};
pub use times::{DAY, HOUR, MINUTE, MONTH, WEEK, YEAR, clock_time, duration};
#[doc(hidden)]
pub use {schemars, serde};
