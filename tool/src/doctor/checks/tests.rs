//! What doctor reports of PCs that lack this or that.

use super::super::facts::SerialPort;
use super::*;

const F446: BoardName = BoardName::NucleoF446re;

fn probe() -> SeenProbe {
    SeenProbe {
        name: "STLink V2-1".to_owned(),
        serial: "066DFF".to_owned(),
        may_open: true,
        chip: Ok(0x421),
        module: None,
    }
}

fn only_probe(facts: &mut Facts) -> &mut SeenProbe {
    &mut facts.probes.as_mut().unwrap()[0]
}

fn complete() -> Facts {
    let targets = ["7em-none-eabihf", "7m-none-eabi", "6m-none-eabi"];
    let targets = targets.map(|of| format!("thumbv{of}")).to_vec();
    Facts {
        toolchain: "1.95.0".to_owned(),
        fetched: targets.clone(),
        targets,
        rustup: Some("1.28.2".to_owned()),
        toolchains: vec!["1.95.0-x86_64-unknown-linux-gnu".to_owned()],
        free_mib: Some(40_000),
        is_linux: true,
        is_root: false,
        has_rules: true,
        probes: Ok(vec![probe()]),
        ports: vec![SerialPort {
            path: "/dev/ttyACM0".into(),
            may_open: true,
        }],
    }
}

fn printed(facts: &Facts, purposes: &[Purpose]) -> Vec<String> {
    checks(facts, F446, purposes).lines
}

fn missing(facts: &Facts) -> String {
    let mut missing = printed(facts, &[]);
    missing.retain(|line| line.starts_with("missing"));
    assert!(missing.len() < 2, "{missing:?}");
    assert_eq!(checks(facts, F446, &[]).is_well, missing.is_empty());
    missing.concat()
}

#[test]
fn each_lack_is_reported_with_what_mends_it() {
    let lacks = |change: fn(&mut Facts), says: &str| {
        let mut facts = complete();
        change(&mut facts);
        let line = missing(&facts);
        assert!(line.starts_with(&format!("missing  {says}")), "{line}");
    };
    lacks(|of| of.rustup = None, "rustup: curl ");
    let target =
        "target thumbv7m-none-eabi: rustup target add --toolchain 1.95.0 thumbv7m-none-eabi";
    lacks(|of| drop(of.fetched.remove(1)), target);
    let room = "free disk, 3.0 GiB (needed: 3 GiB): cargo clean";
    lacks(|of| of.free_mib = Some(3071), room);
    lacks(|of| of.ports.clear(), "serial port of an ST-LINK: plug");
    let port = "serial port /dev/ttyACM0: sudo usermod -aG dialout $USER";
    lacks(|of| of.ports[0].may_open = false, port);
    lacks(|of| of.probes = Ok(Vec::new()), "debug probe: plug");
    lacks(|of| of.probes = Err("built".into()), "debug probe: built");
    let other = "chip STM32F446RETx (found identity 0x410): --board";
    lacks(|of| only_probe(of).chip = Ok(0x410), other);
    let silent = "chip STM32F446RETx: no answer";
    lacks(|of| only_probe(of).chip = Err("no answer".into()), silent);
    let group = "permission for debug probes: sudo usermod -aG plugdev $USER";
    lacks(|of| only_probe(of).may_open = false, group);
    let closed = |of: &mut Facts| {
        of.has_rules = false;
        only_probe(of).may_open = false;
    };
    lacks(closed, "permission for debug probes: echo 'SUBSYSTEM");
}

#[test]
fn without_the_toolchain_its_targets_are_missing_too() {
    let facts = Facts {
        toolchains: vec!["1.95.00-x86_64".to_owned(), "stable-x86_64".to_owned()],
        ..complete()
    };
    let lines = printed(&facts, &[Purpose::Sim]);
    let missing = lines.iter().filter(|line| line.starts_with("missing"));
    assert_eq!(missing.count(), 4, "{lines:?}");
}

#[test]
fn what_a_purpose_does_not_need_is_absent() {
    let facts = Facts {
        probes: Ok(Vec::new()),
        ports: Vec::new(),
        ..complete()
    };
    for (purposes, count) in [
        (&[][..], 2),
        (&[Purpose::Sim], 0),
        (&[Purpose::Probe], 1),
        (&[Purpose::Port], 1),
        (&[Purpose::Sim, Purpose::Port], 1),
    ] {
        let lines = printed(&facts, purposes);
        let begins = |with: &str| lines.iter().filter(|line| line.starts_with(with)).count();
        assert_eq!(begins("missing"), count, "{purposes:?}: {lines:?}");
        assert_eq!(begins("absent"), 2 - count, "{purposes:?}: {lines:?}");
    }
}

#[test]
fn elsewhere_devices_need_no_permission() {
    let facts = Facts {
        is_linux: false,
        has_rules: false,
        ports: Vec::new(),
        ..complete()
    };
    assert_eq!(missing(&facts), "");
}

#[test]
fn the_page_shows_what_is_printed() {
    let page = include_str!("../../../../docs/flashing.md");
    let empty = Facts {
        rustup: None,
        toolchains: Vec::new(),
        fetched: Vec::new(),
        free_mib: Some(1024),
        has_rules: false,
        probes: Ok(Vec::new()),
        ports: Vec::new(),
        ..complete()
    };
    for facts in [empty, complete()] {
        let printed = printed(&facts, &[]).join("\n");
        assert!(page.contains(&printed), "docs/flashing.md: no\n{printed}");
    }
}
