//! `whisker deploy`: a model to a module, without a rebuild.

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::recording::CHANNELS;
use host_sim::{Error, files, misfit, origin, report};
use jiff::Timestamp;

use crate::capture::FIRST_TOUCH;
use crate::conversation::Conversation;
use crate::decides::Decides;
use crate::resting::rest;
use crate::source::{SourceChoice, seconds};

/// Which model, and to which module.
#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// The model, as host-sim train writes it
    #[arg(long, value_name = "FILE")]
    model: PathBuf,
    /// A recording from this bench: says where it is out of the model's range, or has labels
    /// that the model does not know
    #[arg(long, value_name = "FILE")]
    data: Option<PathBuf>,
    /// For how long to print the log afterwards
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
}

/// Deploys it, once it fits, and says what the module then decides by.
pub(crate) fn deploy(arguments: &Arguments) -> Result<(), Error> {
    let (path, model) = files::load_model(&arguments.model)?;
    let mut begun = None;
    if let Some(data) = &arguments.data {
        begun = first_touch(data)?;
        let streams = files::read_recording(data, CHANNELS)?;
        for line in misfit::misfits(data, CHANNELS, &model, &streams) {
            report::warn(line);
        }
    }
    let mut module = Conversation::new(arguments.source.open(0)?);
    module.source().takes(&path, &model)?;
    report::say(format_args!(
        "{}: model {:08x}, {} bytes, {} classes: {}",
        path.display(),
        model.crc(),
        model.as_bytes().len(),
        model.classes(),
        model.names().collect::<Vec<_>>().join(", ")
    ));
    let before = Decides::ask(&mut module)?;
    report::say(format_args!("before, the module {before}"));
    rest(&mut module)?;
    module.source().deploy(&model)?;
    let after = Decides::ask(&mut module)?;
    report::say(format_args!("now it {after}"));
    after.is(&model)?;
    if let Some((of, begun)) = begun {
        let took = Timestamp::now().duration_since(begun).as_secs();
        report::say(format_args!(
            "{} min {} s since the first touch of {of}",
            took / 60,
            took % 60
        ));
    }
    let Some(seconds) = arguments.seconds else {
        return Ok(());
    };
    let begun = module.source().now_s();
    while module.source().now_s() - begun < seconds {
        module.hear()?.lines.iter().for_each(report::say);
    }
    Ok(())
}

/// When the first touch of a recording was, where it says so.
fn first_touch(data: &Path) -> Result<Option<(String, Timestamp)>, Error> {
    let bytes = std::fs::read(data).map_err(|error| Error::file(data, error))?;
    let (origin, ..) = origin::split(&bytes);
    let when = origin.get(FIRST_TOUCH).and_then(|when| when.parse().ok());
    Ok(when.map(|when| (data.display().to_string(), when)))
}
