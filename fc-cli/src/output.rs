//! The option `--format`.

use clap::ValueEnum;

use crate::lang::both;

/// The format of the output. The value `text` is the default.
#[derive(Debug, clap::Args)]
pub struct Output<F: ValueEnum + Send + Sync + 'static> {
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        help = both("输出格式", "Output format")
    )]
    pub format: F,
}
