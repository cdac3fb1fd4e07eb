//! What a line of a module's log says: `TIME LEVEL [SIDE NUMBER:] TEXT`.

/// A line, taken apart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LogLine<'l> {
    /// Since the module's first tick, s; none: the line has no time.
    pub(crate) t_s: Option<f64>,
    /// `INFO`, `WARN` or `ERROR`, where it has one.
    pub(crate) level: Option<&'l str>,
    /// The side of the whisker that it is about, where it names one: 0 left, 1 right.
    pub(crate) side: Option<u8>,
    /// What is left.
    pub(crate) text: &'l str,
    /// What that says.
    pub(crate) news: News<'l>,
}

/// What a line says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum News<'l> {
    /// A touch with this number begins.
    Touch(u16),
    /// It has ended.
    TouchEnd(u16),
    /// A decision fell.
    Decision {
        /// The class, or that it is none.
        class: &'l str,
        /// Its posterior, 0 to 1.
        posterior: f64,
        /// Samples that it used.
        samples: u32,
    },
    /// A fault or limit with this number in the table of faults.
    Fault(u8),
    /// The line of each second: how the ticks keep their time.
    Health(Health),
    /// Something else.
    Other,
}

/// How the ticks keep their time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Health {
    /// The longest tick of the last second, and what there is from one to the next, us.
    pub(crate) longest_us: f64,
    pub(crate) period_us: f64,
    /// Ticks that were missed, and events that were dropped, since the start.
    pub(crate) missed: u64,
    pub(crate) dropped: u64,
}

impl<'l> LogLine<'l> {
    /// Takes a line apart.
    pub(crate) fn of(line: &'l str) -> Self {
        let mut rest = line.trim();
        let mut t_s = None;
        if let Some((first, more)) = rest.split_once(' ')
            && let Ok(time) = first.parse::<f64>()
        {
            (t_s, rest) = (Some(time), more.trim_start());
        }
        let levels = ["INFO", "WARN", "ERROR", "DEBUG", "TRACE"];
        let level = levels.into_iter().find(|level| {
            rest.strip_prefix(level)
                .is_some_and(|more| more.starts_with(' '))
        });
        rest = rest[level.map_or(0, str::len)..].trim_start();
        let side = ["left ", "right "].iter().zip(0..);
        let side = side.filter(|(name, _)| rest.starts_with(**name));
        let side = side.map(|(_, side)| side).next();
        if let (Some(_), Some((_, more))) = (side, rest.split_once(": ")) {
            rest = more;
        }
        Self {
            t_s,
            level,
            side,
            text: rest,
            news: news(rest),
        }
    }
}

fn news(text: &str) -> News<'_> {
    let found = (|| {
        if let Some(touch) = text.strip_prefix("touch ") {
            return Some(match touch.strip_suffix(" has ended") {
                Some(number) => News::TouchEnd(number.parse().ok()?),
                None => News::Touch(touch.parse().ok()?),
            });
        }
        if let Some(decision) = text.strip_prefix("decision: ") {
            // A class may have any name.
            let (class, figures) = decision.rsplit_once(", posterior ")?;
            let (percent, samples) = figures.split_once(" %, ")?;
            return Some(News::Decision {
                class,
                posterior: percent.parse::<f64>().ok()? / 100.0,
                samples: samples.strip_suffix(" samples")?.parse().ok()?,
            });
        }
        if let Some(health) = text.strip_prefix("longest tick ") {
            let (longest, rest) = health.split_once(" us of ")?;
            let (period, rest) = rest.split_once("; missed ")?;
            let (missed, dropped) = rest.split_once(", events dropped ")?;
            return Some(News::Health(Health {
                longest_us: longest.parse().ok()?,
                period_us: period.parse().ok()?,
                missed: missed.parse().ok()?,
                dropped: dropped.parse().ok()?,
            }));
        }
        let told = ["fault ", "limit "]
            .iter()
            .find_map(|word| text.strip_prefix(word))?;
        let (number, _) = told.split_once(',')?;
        Some(News::Fault(number.parse().ok()?))
    })();
    found.unwrap_or(News::Other)
}

#[cfg(test)]
mod tests {
    use super::{Health, LogLine, News};

    #[test]
    fn a_line_has_its_time_level_side_and_news() {
        let line = LogLine::of("1.250 ERROR right 0: fault 6, driven but not moving (blocked?)");
        assert_eq!((line.t_s, line.level), (Some(1.25), Some("ERROR")));
        assert_eq!((line.side, line.news), (Some(1), News::Fault(6)));
        assert_eq!(line.text, "fault 6, driven but not moving (blocked?)");
        let line = LogLine::of("2.000 WARN  limit 32, ticks were missed (a debugger?)");
        assert_eq!((line.side, line.news), (None, News::Fault(32)));
        let line = LogLine::of("(a broken line)");
        assert_eq!((line.t_s, line.level, line.side), (None, None, None));
        assert_eq!(line.text, "(a broken line)");
    }

    #[test]
    fn each_kind_of_line_is_told_from_the_others() {
        let news = |line| LogLine::of(line).news;
        assert_eq!(news("1.0 INFO  touch 12"), News::Touch(12));
        assert_eq!(
            news("1.0 INFO  left 0: touch 12 has ended"),
            News::TouchEnd(12)
        );
        let text = "1.5 INFO  decision: a, b, posterior 99.1250 %, 640 samples";
        let (class, posterior, samples) = ("a, b", 0.991_25, 640);
        let decision = News::Decision {
            class,
            posterior,
            samples,
        };
        assert_eq!(news(text), decision);
        let text = "1.0 INFO  longest tick 43.7 us of 500; missed 1, events dropped 2";
        let health = Health {
            longest_us: 43.7,
            period_us: 500.0,
            missed: 1,
            dropped: 2,
        };
        assert_eq!(news(text), News::Health(health));
        for other in [
            "1.0 INFO  touch down",
            "1.0 ERROR - the last: fault 6, x",
            "",
        ] {
            assert_eq!(news(other), News::Other, "{other}");
        }
    }
}
