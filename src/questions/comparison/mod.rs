//! Methods compared with each other: by cost, by situation, by stiffness, by one differing input, and
//! with other programs.

pub mod peers;
pub mod stability_map;
pub mod stiffness_sweep;
pub mod twins;
pub mod work_precision;
