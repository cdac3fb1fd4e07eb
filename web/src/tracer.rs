//! A scene from its start to its end, as `trace.csv` and its hash.

use host_sim::run::Run;
use host_sim::trace::{TraceShape, TraceWriter, WhiskerRow};
use sha2::{Digest, Sha256};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::started;

/// The bytes of a trace: hashed, and kept where they are wanted.
#[derive(Default)]
struct Sink {
    hash: Sha256,
    keeps: bool,
    bytes: Vec<u8>,
}

impl std::io::Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.hash.update(bytes);
        if self.keeps {
            self.bytes.extend(bytes);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// A run of a scene that is written, part by part.
#[wasm_bindgen]
pub struct Tracer {
    run: Run,
    left: u64,
    whiskers: Vec<WhiskerRow>,
    table: Option<TraceWriter<Sink>>,
    written: Sink,
}

#[wasm_bindgen]
impl Tracer {
    /// Before its first tick; the bytes are kept if `keeps` says so.
    ///
    /// # Errors
    /// What is wrong with the scene, a line each.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, set: &str, keeps: bool) -> Result<Self, String> {
        let (scene, run) = started(text, set)?;
        let sink = Sink {
            keeps,
            ..Sink::default()
        };
        let table = TraceWriter::new(sink, TraceShape::of(&scene));
        Ok(Self {
            left: run.ticks(),
            run,
            whiskers: Vec::new(),
            table: Some(table.map_err(|error| error.to_string())?),
            written: Sink::default(),
        })
    }

    /// Goes on by up to so many ticks; says whether the scene has ended.
    pub fn step(&mut self, ticks: u32) -> bool {
        let Some(table) = &mut self.table else {
            return true;
        };
        for _ in 0..u64::from(ticks).min(self.left) {
            self.run.tick();
            self.left -= 1;
            let decided: Vec<_> = self.run.decisions().collect();
            self.run.look_at_whiskers(&mut self.whiskers);
            // A sink of this kind refuses nothing.
            let _ = table.line(&self.run.trace_line(&decided, &self.whiskers));
        }
        if self.left == 0
            && let Some(table) = self.table.take()
        {
            self.written = table.into_inner();
        }
        self.left == 0
    }

    /// SHA-256 of the trace, once the scene has ended.
    pub fn hash(&self) -> String {
        let hash = self.written.hash.clone().finalize();
        let digits = hash.iter().map(|byte| format!("{byte:02x}"));
        digits.collect()
    }

    /// What was written since the last call, if it is kept.
    pub fn bytes(&mut self) -> Vec<u8> {
        let table = self.table.as_mut().map(TraceWriter::inner_mut);
        core::mem::take(&mut table.unwrap_or(&mut self.written).bytes)
    }
}
