//! `whisker monitor`: a window in which one watches a module.

use std::io::{self, IsTerminal};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex};
use std::thread;

use clap::Args;
use host_sim::origin::Origin;
use host_sim::{Error, output, report};
use wire::Command;

use crate::conversation::AboutModule;
use crate::monitor::{
    About, History, Known, Listener, Looking, Shared, Shown, Size, Watching, Wish, drawn, joined,
    lock, open, size, svg, text,
};
use crate::record_file::{self, RecordFile};
use crate::script::Script;
use crate::source::{SourceChoice, seconds};

const PICTURES_HZ: f64 = 20.0;

#[derive(Debug, Clone, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// The model by which the PC says how sure it is, in place of the scene's
    #[arg(long, value_name = "FILE.model")]
    model: Option<PathBuf>,
    /// Where to record all that comes meanwhile: a table (.csv) or messages (.mcap); may be given
    /// several times. An existing file is not overwritten
    #[arg(long, value_name = "FILE.csv|FILE.mcap")]
    out: Vec<PathBuf>,
    /// Where the key s saves the last minutes; a number is put behind the name of a file that is
    /// there already
    #[arg(long, value_name = "FILE.csv|FILE.mcap", default_value = "monitor.csv")]
    save: PathBuf,
    /// Seconds of the module in a second; without it 1 for --sim, and as fast as it goes for
    /// --emulated
    #[arg(long, value_name = "N", value_parser = seconds)]
    speed: Option<f64>,
    /// Commands for the module, as for whisker records: lines TIME COMMAND [SIDE [VALUE]]
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// For how long; without it until it is ended
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
    /// Opens no window, but shows the last of so many pictures, 20 in a second of the module, as
    /// text
    #[arg(long, value_name = "N", conflicts_with_all = ["seconds", "speed", "save"], value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: Option<u32>,
    /// Columns and rows of that picture
    #[arg(long, value_name = "COLUMNSxROWS", requires = "frames", default_value = "100x30", value_parser = size)]
    size: Size,
    /// Draws it to a file instead
    #[arg(long, value_name = "FILE.svg", requires = "frames")]
    snapshot: Option<PathBuf>,
}

pub(crate) fn monitor(arguments: &Arguments) -> Result<(), Error> {
    for path in &arguments.out {
        record_file::check_new(path)?;
    }
    record_file::check(&arguments.save)?;
    if let Some(path) = &arguments.snapshot {
        output::check(path)?;
        if path.extension().is_none_or(|extension| extension != "svg") {
            let fault = "--snapshot: allowed: a name that ends in .svg";
            return Err(Error::file(path, fault));
        }
    }
    let is_window = arguments.frames.is_none();
    if is_window && !(io::stdin().is_terminal() && io::stdout().is_terminal()) {
        let fault = "a window needs a terminal; without one: --frames N, or whisker records";
        return Err(Error::Input(fault.to_owned()));
    }
    if !is_window {
        let ready = output::remove_on_interrupt();
        ready.map_err(|error| Error::Work(format!("interrupts: {error}")))?;
    }
    let (wish, wishes) = mpsc::channel();
    let (ready, readied) = mpsc::channel();
    let own = arguments.clone();
    let listening = thread::Builder::new().name("listening".to_owned());
    // The module is opened where it is listened to: not every one can be handed on.
    let listener = listening.spawn(move || {
        let (watching, is_ready) = begin(&own, wishes)?;
        // Whoever asked for it waits.
        let _ = ready.send(is_ready);
        watching.run()
    });
    let listener = listener.map_err(|error| Error::Work(format!("thread: {error}")))?;
    let Ok((shared, about)) = readied.recv() else {
        // Why, it says itself.
        return joined(listener);
    };
    if is_window {
        return open(&shared, about, listener, &wish);
    }
    joined(listener)?;
    let shown = Shown::first(&lock(&shared).history, &about.title);
    let picture = drawn(&shown, arguments.size)?;
    if let Some(path) = &arguments.snapshot {
        return output::write_whole(path, svg(&picture).as_bytes());
    }
    report::say(text(&picture).trim_end());
    Ok(())
}

type Ready = (Arc<Mutex<Shared>>, About);

fn begin(arguments: &Arguments, wishes: Receiver<Wish>) -> Result<(Watching, Ready), Error> {
    let scene = arguments.source.scene();
    let known = Known::of(scene, arguments.model.as_deref())?;
    if arguments.model.is_some() {
        arguments.source.sends_all()?;
    }
    // Without every record it decides nothing here.
    let known = known.filter(|_| arguments.source.sends_all().is_ok());
    let script = Script::of(arguments.script.as_deref(), &arguments.source)?;
    let mut module = arguments.source.module()?;
    let begun_s = module.now_s();
    // From the first tick on: how the whisker swings in the air is learnt from.
    module.ask(Command::Stream(true))?;
    let AboutModule {
        scene,
        tick_hz,
        whiskers,
    } = module.about()?;
    let classes = module.classes()?;
    let looking = Looking::of(&mut module, &arguments.source)?;
    let listener = known.map(|known| Listener::new(known, tick_hz, whiskers));
    let origin: Origin = module.origin()?.with("scene", &scene);
    let files = arguments.out.iter();
    let files = files.map(|path| RecordFile::create(path, &origin, tick_hz, &classes));
    let files = files.collect::<Result<Vec<_>, _>>()?;
    let board = origin.get("board").unwrap_or("unknown").to_owned();
    let mut title = format!("{scene}, {board}, {tick_hz} Hz");
    if !files.is_empty() {
        title.push_str(", recording");
    }
    let rate = (tick_hz, module.every(tick_hz));
    let mut history = History::new(rate, whiskers, listener.transpose()?);
    history.module_classes = classes;
    let shared = Arc::new(Mutex::new(Shared {
        history,
        message: None,
        has_ended: false,
        saving: Vec::new(),
    }));
    let frames = arguments.frames.map(f64::from);
    let watching = Watching {
        module,
        script,
        tick_hz,
        files,
        shared: shared.clone(),
        wishes,
        speed: match arguments.frames {
            Some(_) => None,
            None => arguments.speed.or(arguments.source.pace()),
        },
        begun_s,
        looking,
        looked_s: begun_s,
        most_s: frames.map_or(arguments.seconds, |frames| Some(frames / PICTURES_HZ)),
    };
    let about = About {
        title,
        origin,
        save: arguments.save.clone(),
    };
    Ok((watching, (shared, about)))
}
