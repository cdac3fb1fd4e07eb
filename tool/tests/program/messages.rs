//! Files of messages (MCAP), read back by the library that others use.

use std::collections::BTreeMap;

use mcap::MessageStream;
use serde_json::Value;

use crate::common::Place;

/// What is in the channels of a file: time in ns, and message.
pub(crate) fn channels(bytes: &[u8]) -> BTreeMap<String, Vec<(u64, Value)>> {
    let mut channels: BTreeMap<String, Vec<(u64, Value)>> = BTreeMap::new();
    for message in MessageStream::new(bytes).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.as_ref().unwrap();
        assert_eq!(schema.encoding, "jsonschema");
        assert_eq!(message.channel.message_encoding, "json");
        let value: Value = serde_json::from_slice(&message.data).unwrap();
        let schema: Value = serde_json::from_slice(&schema.data).unwrap();
        fits(&value, &schema);
        let of = channels.entry(message.channel.topic.clone()).or_default();
        of.push((message.log_time, value));
    }
    channels
}

/// The keys of a message are those of its schema, and of its types.
fn fits(value: &Value, schema: &Value) {
    let properties = schema["properties"].as_object().unwrap();
    let object = value.as_object().unwrap();
    assert!(object.keys().eq(properties.keys()), "{value} {schema}");
    for (key, property) in properties {
        let found = &object[key];
        let is_so = match property["type"].as_str().unwrap() {
            "boolean" => found.is_boolean(),
            "string" => found.is_string(),
            "integer" => found.is_i64() || found.is_u64(),
            "number" => found.is_number(),
            "array" => found.is_array(),
            "object" => found.is_object(),
            other => panic!("{other}"),
        };
        assert!(is_so, "{key}: {found} {property}");
    }
}

#[test]
fn messages_are_the_table_and_the_log() {
    let place = Place::new();
    let of = "--sim @textures.toml --seconds 2.6";
    for out in ["r.csv", "r.mcap"] {
        let ran = place.done(&format!("records {of} --out {out}"));
        ran.prints("5200 records at 2000");
    }
    let channels = channels(&std::fs::read(place.path("r.mcap")).unwrap());

    let table = place.text("r.csv");
    let mut rows = table.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = rows.next().unwrap().split(',').collect();
    let records = &channels["/left/records"];
    assert!(!channels.contains_key("/right/records"));
    assert_eq!(records.len(), 5200);
    for ((ns, record), row) in records.iter().zip(rows.by_ref()) {
        let cells: Vec<&str> = row.split(',').collect();
        assert_eq!(record.as_object().unwrap().len(), header.len());
        for (column, cell) in header.iter().zip(cells) {
            let is_same = match &record[*column] {
                Value::Bool(so) => cell == if *so { "1" } else { "0" },
                Value::String(text) => cell == text,
                number => cell.parse::<f64>().ok() == number.as_f64(),
            };
            assert!(is_same, "{column}: {cell}, {record}");
        }
        // A tick is half a millisecond.
        assert_eq!(*ns, record["sequence"].as_u64().unwrap() * 500_000);
    }
    assert_eq!(rows.next(), None);

    let log = place.done(&format!("log {of}")).stdout;
    let logged = &channels["/log"];
    let said = logged.iter().map(|(_, line)| &line["message"]);
    assert!(said.eq(log.lines()), "{logged:?}");
    let decisions = &channels["/decisions"];
    let lines = log.lines().filter(|line| line.contains("decision"));
    let lines: Vec<&str> = lines.collect();
    assert!(lines.len() >= 3 && lines.len() == decisions.len(), "{log}");
    for (line, (_, decision)) in lines.iter().zip(decisions) {
        // The line cuts it.
        let percent = (1e6 * decision["posterior"].as_f64().unwrap()).floor() / 1e4;
        let why = match (&decision["reason"], &decision["among"]) {
            (reason, Value::Array(among)) if reason == "between" => {
                let [leader, rival] = [0, 1].map(|n| among[n].as_str().unwrap());
                format!(" between {leader} and {rival}")
            }
            (reason, _) if reason == "pose" => " outside the poses of training".to_owned(),
            _ => String::new(),
        };
        let again = format!(
            "{:.3} INFO  decision {} {} {percent:.4} {}{why}",
            decision["t_s"].as_f64().unwrap(),
            decision["side"].as_str().unwrap(),
            decision["decision"].as_str().unwrap(),
            decision["samples"]
        );
        assert_eq!(again, *line);
    }
    let events = channels["/events"].iter().map(|(_, event)| {
        assert_eq!(event["fault"], 0);
        let said = event["said"].as_str().unwrap();
        format!("{:.3} INFO  {said}", event["t_s"].as_f64().unwrap())
    });
    let touches = log.lines().filter(|line| !line.contains("decision"));
    assert!(events.eq(touches), "{log}");
}

#[test]
fn the_ending_says_what_a_file_is() {
    let place = Place::new();
    let why = "r.bag: what is it to be? allowed: a name that ends in .csv (a table) or .mcap";
    place.refuses("records --sim bench.toml --out r.bag", why);
}
