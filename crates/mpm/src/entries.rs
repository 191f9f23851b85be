//! Tables of what other crates call, so that it is compiled in this one.
//!
//! Generic code is compiled by the crate that calls it, and as that one is built: in many units and hardly optimised a step
//! takes five times as long. Where a step begins stands therefore a table with a static for lines and one for planes, which
//! are compiled here.

use std::any::Any;

/// Of the tables of lines and of planes the one of the number of dimensions that is asked for.
///
/// # Panics
/// Where it is neither.
pub(crate) fn of_dimension<T: Any>(line: &'static dyn Any, plane: &'static dyn Any) -> &'static T {
    line.downcast_ref().or_else(|| plane.downcast_ref()).expect("one or two dimensions")
}
