//! The lines of a serial port as a log has them: docs/serial.md lists the former.

/// What a line says.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Said {
    /// Ticks a second: the reply to `hello`.
    Hello { tick_hz: u32 },
    /// Something at a time, s since the first tick, as the log has it.
    Logged { t_s: f64, text: String },
    /// A reply, or what is no line of this version.
    Other,
}

/// Takes a line.
pub(super) fn logged(line: &str) -> Said {
    let words: Vec<&str> = line.split(' ').collect();
    if let ["ok", "hello", _, tick_hz, _, _] = words[..]
        && let Ok(tick_hz) = tick_hz.parse()
        && tick_hz > 0
    {
        return Said::Hello { tick_hz };
    }
    let Some((time, text)) = line.split_once(' ') else {
        return Said::Other;
    };
    let Some(t_s) = time.parse().ok().filter(|t_s: &f64| t_s.is_finite()) else {
        return Said::Other;
    };
    let text = news(text).unwrap_or_else(|| format!("INFO  {text}"));
    let text = format!("{time} {text}");
    Said::Logged { t_s, text }
}

/// What stands behind the time, by the log's words.
fn news(text: &str) -> Option<String> {
    let words: Vec<&str> = text.split(' ').collect();
    // Number, name and causes.
    let fault = |from: usize| {
        let rest = text.splitn(from + 2, ' ').nth(from + 1)?;
        Some(format!("{}, {rest}", words.get(from)?))
    };
    Some(match words[..] {
        ["touch", side, number] => format!("INFO  {side} 0: touch {number}"),
        ["end", side, number] => format!("INFO  {side} 0: touch {number} has ended"),
        ["decision", side, class, percent, samples] => {
            format!("INFO  {side} 0: decision: {class}, posterior {percent} %, {samples} samples")
        }
        ["fault", "board", ..] => format!("ERROR fault {}", fault(2)?),
        ["fault", side, ..] => format!("ERROR {side} 0: fault {}", fault(2)?),
        ["limit", ..] => format!("WARN  limit {}", fault(1)?),
        ["back", side] => format!("INFO  {side} 0: sensor is back"),
        ["retry", side] => format!("INFO  {side} 0: motor is tried again"),
        ["off", side] => {
            format!("ERROR {side} 0: three faults in a minute: motor off until armed")
        }
        ["health", worst, period, missed, dropped, _] => format!(
            "INFO  longest tick {worst} us of {period}; missed {missed}, events dropped {dropped}"
        ),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{Said, logged};

    #[test]
    fn lines_become_those_of_the_log() {
        for (line, expected) in [
            ("1.204 touch left 7", "1.204 INFO  left 0: touch 7"),
            ("1.4 end right 7", "1.4 INFO  right 0: touch 7 has ended"),
            (
                "1.221 decision left carpet 99.5284 34",
                "1.221 INFO  left 0: decision: carpet, posterior 99.5284 %, 34 samples",
            ),
            (
                "2.0 fault left 18 no sensor answers (open; no supply?)",
                "2.0 ERROR left 0: fault 18, no sensor answers (open; no supply?)",
            ),
            (
                "0.000 fault board 49 hard fault (a fault?)",
                "0.000 ERROR fault 49, hard fault (a fault?)",
            ),
            (
                "3.0 limit 32 ticks were missed (a?)",
                "3.0 WARN  limit 32, ticks were missed (a?)",
            ),
            (
                "1.000 health 43.7 500 1 2 3",
                "1.000 INFO  longest tick 43.7 us of 500; missed 1, events dropped 2",
            ),
            ("0.000 armed", "0.000 INFO  armed"),
        ] {
            let Said::Logged { text, .. } = logged(line) else {
                panic!("{line}");
            };
            assert_eq!(text, expected);
        }
    }

    #[test]
    fn replies_are_told_from_lines_with_a_time() {
        let hello = Said::Hello { tick_hz: 2000 };
        assert_eq!(logged("ok hello textures 2000 1 0.1.0"), hello);
        for line in [
            "ok hello x 0 1 0.1.0",
            "ok arm",
            "refused: too long",
            "",
            "nan x",
        ] {
            assert_eq!(logged(line), Said::Other, "{line}");
        }
    }
}
