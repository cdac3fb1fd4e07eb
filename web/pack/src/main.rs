//! One HTML file from the page's parts: `pack CORE.wasm PAGE OUT.html`, PAGE being the folder with
//! page.html, page.css and main.js with the modules that it imports.
//!
//! The core is compressed and encoded as text, as a page that is opened from disk may load nothing
//! else; the browser's own DecompressionStream undoes it. The content security policy names the
//! hashes of scripts and style: whatever else got into the page would not run.

mod modules;

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::{env, fs};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use sha2::{Digest, Sha256};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [core, page, out] = arguments.as_slice() else {
        return Err("allowed: CORE.wasm PAGE OUT.html".into());
    };
    let (page, out) = (Path::new(page), Path::new(out));
    let mut bound = Bindgen::new()
        .input_path(core)
        .no_modules(true)?
        .typescript(false)
        .generate_output()?;
    let glue = bound.js().to_owned();
    let wasm = bound.wasm_mut().emit_wasm();

    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&wasm)?;
    let core = STANDARD.encode(packed.finish()?);

    let css = fs::read_to_string(page.join("page.css"))?;
    let program = modules::joined(page, "main.js")?;
    let sum = |content: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(content)));
    let parts = [
        ("SCRIPTS", format!("{} {}", sum(&glue), sum(&program))),
        ("STYLE", sum(&css)),
        ("/* page.css */", css),
        ("/* glue */", glue),
        ("/* main.js */", program),
        ("<!-- core -->", core),
    ];
    let mut html = fs::read_to_string(page.join("page.html"))?;
    for (place, content) in parts {
        if html.matches(place).count() != 1 {
            return Err(format!("page.html: {place} is not there once").into());
        }
        html = html.replacen(place, &content, 1);
    }
    if let Some(folder) = out.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(out, &html)?;
    println!(
        "{}: {} bytes, core {} bytes",
        out.display(),
        html.len(),
        wasm.len()
    );
    Ok(())
}
