//! Whole runs through the program, as its users call it: a folder a command, and in `score` a file a foreign program.

mod packs;
mod program;

mod all_commands {
    mod bad_input;
    mod escapes;
    mod exit_codes;
    mod first_hour;
    pub mod outputs;
    pub mod place;
    mod streams;
    mod tools;
}
mod check {
    mod given_results;
    mod impossible_results;
    mod other_inputs;
    mod planted_bug;
    mod proposed;
    mod refused;
    mod verdicts;
}
mod exact {
    mod portable;
    mod problems;
    mod textbook;
}
mod history {
    mod repository;
    mod repository_of_a_solver;
}
mod manual {
    mod names;
    pub mod pages;
    mod release;
}
mod report {
    mod every_cell;
    mod own_studies;
    pub mod pages;
}
mod run {
    mod attached;
    mod attached_plane;
    mod attached_whole;
    mod damage;
    mod many_cases;
    mod records;
    mod signals;
    mod slurm;
    mod store;
    mod trust;
    mod units;
}
mod score {
    mod anura3d;
    mod any_program;
    mod cb_geo;
    mod formats;
    mod geotaichi;
    mod incomplete;
    mod kratos;
    mod mapping;
    mod mpm_geomechanics;
    mod ogs;
    mod porepy;
    pub mod real_files;
    mod verdicts;
    pub mod written_files;
}
mod solve {
    mod contract;
    mod manufactured;
    mod plate_and_weight;
    mod soils;
}
mod stability {
    mod critical_step;
}
