//! Whole runs through the program, as its users call it.

mod attach;
mod attach_plane;
mod bad_input;
mod check;
mod critical_step;
mod first_hour;
mod foreign;
mod gate;
mod impossible_results;
mod manufactured;
mod mapping;
mod planted_damage;
mod plate_and_weight;
mod portable;
mod program;
mod readme;
mod report_rules;
mod report_tables;
mod run;
mod score;
mod signals;
mod solve;
mod store;
mod streams;
mod tools;
mod wide;
