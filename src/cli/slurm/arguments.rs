//! How a user wants a cluster to be used.

/// Folder of a campaign's scripts and logs within that of the results.
pub const FOLDER: &str = "slurm";

/// How to run on a cluster.
#[derive(Debug, clap::Args)]
pub struct ClusterArguments {
    /// Shares, each a task of the array
    #[arg(long, value_name = "N", default_value_t = 16, requires = "engine", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub tasks: u64,
    /// Partition of the cluster
    #[arg(long, value_name = "NAME", requires = "engine")]
    pub partition: Option<String>,
    /// Longest time of a task, as Slurm writes it: minutes, or hours:minutes:seconds
    #[arg(long, value_name = "TIME", requires = "engine")]
    pub time: Option<String>,
    /// Cores of a task
    #[arg(long, value_name = "N", default_value_t = 1, requires = "engine", value_parser = clap::value_parser!(u64).range(1..=1024))]
    pub cores: u64,
    /// A further option of sbatch, like --sbatch=--account=soil
    #[arg(long, value_name = "OPTION", requires = "engine", allow_hyphen_values = true)]
    pub sbatch: Vec<String>,
    /// How often what is missing is submitted, the first time included
    #[arg(long, value_name = "N", default_value_t = 3, requires = "engine", value_parser = clap::value_parser!(u64).range(1..=100))]
    pub attempts: u64,
    /// Submit and end, without following
    #[arg(long, requires = "engine")]
    pub detach: bool,
    /// Print the scripts and the commands that would submit them, and do nothing
    #[arg(long, requires = "engine")]
    pub dry_run: bool,
}
