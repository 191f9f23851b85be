//! The figures of a page of the report, each made from the records of its study.

pub mod cheapest_method_map;
pub mod critical_step_maps;
pub mod drawn_paths;
pub mod error_over_time;
pub mod error_over_work;
pub mod plane_fields;
pub mod theory_lines;
