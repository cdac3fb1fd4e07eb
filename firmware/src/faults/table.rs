//! The table of faults and limits: the only place where their texts stand.
//!
//! A row is `number NAME: "what is wrong (likely causes?)", "what to check", reaction,
//! recovery;`. The first text is what a board logs; all of it becomes `docs/faults.md` (`cargo
//! xtask docs --quick`). A number never changes its meaning and is never used again.
//!
//! | numbers | of |
//! |---|---|
//! | 1 to 15 | a motor; [`whisking::motor::Fault::code`] gives them |
//! | 16 to 31 | a sensor; [`SensorFault::code`](crate::SensorFault::code) |
//! | 32 to 47 | limits |
//! | 48 on | the board and its program |

/// Hands every row of the table to the macro `$then`, so that each user takes from it what
/// it needs. (A logger wants texts as literals.)
#[macro_export]
macro_rules! fault_table {
    ($then:ident) => {
        $then! {
            1 MOTOR_PIN: "a motor pin failed (an I/O expander off its bus; the chip's own pins do not fail?)",
                "the expander's supply and bus",
                WhiskerOff, Retry;
            2 MOTOR_PWM: "a PWM channel failed (an external PWM chip off its bus; the chip's own timer does not fail?)",
                "that chip's supply and bus",
                WhiskerOff, Retry;
            3 HALL_LOW: "impossible Hall code 0 (Halls without supply; their cable shorted?)",
                "the Halls' supply at the motor",
                WhiskerOff, Retry;
            4 HALL_HIGH: "impossible Hall code, mostly 7 (Hall cable unplugged; Halls spaced at 60 degrees?)",
                "the plug; the driver needs Halls 120 degrees apart",
                WhiskerOff, Retry;
            5 SKIPPED_SECTOR: "Hall sectors skipped (motor too fast for the tick; noise; two Halls exchanged?)",
                "turn it by hand: forward must show 1, 3, 2, 6, 4, 5",
                WhiskerOff, Retry;
            6 STALL: "does not move as it is driven (held; encoder stuck; a winding open; motor supply off; Halls and phases in different order?)",
                "[the whisker](troubleshooting.md#the-whisker)",
                WhiskerOff, Retry;
            7 FOLLOWING: "does not follow its setpoint (held; encoder slipping or losing counts; gains too low?)",
                "whether it moves freely; `following_limit_deg`",
                WhiskerOff, Retry;
            8 RUNAWAY: "runs away (motor or encoder wired the wrong way round; noise on the encoder's lines?)",
                "exchange the motor's two wires, or A and B; `top_speed_deg_s`",
                WhiskerOff, Retry;
            9 ENCODER: "driven and not a count (encoder without supply or not connected; motor supply off; whisker clamped; a winding open?)",
                "the supplies of encoder and motor; A and B with an oscilloscope; whether it moves freely",
                WhiskerOff, Retry;
            10 TRAVEL: "beyond its travel (not at rest at the start; turned by something?)",
                "start it retracted; `min_deg`, `max_deg`, `travel_margin_deg`",
                WhiskerOff, Retry;
            11 HEAT: "winding too hot (pressing against something for long; friction?)",
                "what it presses against; `continuous_duty`",
                WhiskerOff, Retry;
            12 HOMING: "retracted stop not found (the whisker turns freely, or too slowly; something was taken for the stop, or stands in its range?)",
                "the stop; `homing_duty`; that nothing is within reach; `far_stop_deg`",
                WhiskerOff, Retry;
            13 LOST_COUNTS: "the encoder has lost counts, or the stop is not where it was (a loose contact of the encoder; something was taken for the stop?)",
                "A and B with an oscilloscope, the plug moved by hand; the coupling of the encoder; that nothing is within reach. Without homing it is given up at once: reset the board with the whisker at rest",
                WhiskerOff, Retry;

            16 NO_FRAME: "no frame in time (none was started: follows another fault?)",
                "the line before it",
                WhiskerOff, GoodFrames;
            17 BUS: "SPI or its DMA failed (clock or /SS shorted hard; a fault of this program?)",
                "unplug the sensor: if it stays, report it",
                WhiskerOff, GoodFrames;
            18 NO_SENSOR: "no sensor answers (/SS, SCLK or data line open; no supply; sensor still starting?)",
                "/SS and SCLK at the sensor with an oscilloscope; 5 V there",
                WhiskerOff, GoodFrames;
            19 LINE_LOW: "data line stuck low (no pull-up; short to ground; something drives the line?)",
                "the line at rest: it must be high",
                WhiskerOff, GoodFrames;
            20 BAD_START: "bad start of frame (slow edges; gaps too short for the sensor's mode; a frame cut short?)",
                "smaller pull-up, shorter cable; a lower `tick_hz` for longer gaps",
                WhiskerOff, GoodFrames;
            21 BAD_SUM: "bad sum (noise; slow edges; if every frame fails, the sum rule?)",
                "as 20; [every frame](troubleshooting.md#the-sensor)",
                WhiskerOff, GoodFrames;
            22 SENSOR_REPORT: "the sensor reports an error (magnet too far, too near or off axis; its converter?)",
                "the lines below it; the magnet; keep the motor's magnet away",
                WhiskerOff, GoodFrames;
            23 STUCK_WORDS: "both words all zeros or all ones (the line is held low or let go after the first byte; a sensor without a field?)",
                "as 19; the sensor's program",
                WhiskerOff, GoodFrames;
            24 FROZEN: "readings repeat to the bit (the sensor's converter stands still while it answers; readings of something else?)",
                "supply of the sensor off and on; if it stays, another sensor; `frozen_s`",
                WhiskerOff, GoodFrames;
            25 JUMP: "readings jump (two sensors on one line; noise that the sum does not see; the magnet is loose?)",
                "/SS of each sensor; the magnet; `jump_per_s`",
                WhiskerOff, GoodFrames;
            26 OFTEN: "too many bad frames (a loose contact; noise; slow edges?)",
                "what the line below it says of the last one",
                WhiskerOff, GoodFrames;

            27 TILT_NO_SENSOR: "no TMAG5170 answers (/CS, SCK or SDO open; no supply; sensor still starting?)",
                "/CS and SCK at the sensor with an oscilloscope; 3.3 V there",
                WhiskerOff, GoodFrames;
            28 TILT_LINE_LOW: "SDO stuck low (short to ground; something drives the line; SDI and SDO exchanged?)",
                "the line while /CS is high: it must be high",
                WhiskerOff, GoodFrames;
            29 TILT_CHECK: "check bits of a TMAG5170 are wrong (noise on SDI, SDO or SCK; a clock too fast; SDI open?)",
                "the lines below it: whether commands or replies; shorter cable",
                WhiskerOff, GoodFrames;
            30 TILT_REPORT: "the TMAG5170 reports an error (its supply dips; its own checks; a setting that it does not take?)",
                "the lines below it; the capacitor at its supply",
                WhiskerOff, GoodFrames;
            31 TILT_NO_MAGNET: "no magnet over the TMAG5170 (magnet missing, too far or upside down; not converted yet?)",
                "the gap: [mount](build.md#field-and-gap); turn the magnet over",
                WhiskerOff, GoodFrames;

            32 MISSED: "ticks were missed (a debugger halted the core; a tick took too long?)",
                "*longest tick* in the log; leave parts of the scene out",
                GoesOn, Counted;
            33 DROPPED: "events were dropped (more events in a tick than idle can log, by a fault that comes and goes?)",
                "that fault",
                GoesOn, Counted;
            34 NO_MODEL: "no model to decide by (none was deployed; writing it was interrupted; one of another scene or version?)",
                "the line below it; `whisker deploy` ([flashing.md](flashing.md))",
                GoesOn, Deployed;
            35 UNFELT: "whisking does not move a reading (magnet gone; whisker broken off; sensor frozen but for its noise?)",
                "the magnet and the whisker; `swing_codes`; no contact is reported meanwhile",
                GoesOn, Counted;
            36 AT_END: "a reading is at the end of its range (magnet off its place; too near, or turned over?)",
                "the gap: [mount](build.md#field-and-gap); no contact is reported meanwhile",
                GoesOn, Counted;

            37 INTERNAL_CLOCK: "the clock is the chip's own (a supply without a PC, from which the ST-LINK has no clock to give; solder bridges?)",
                "whether it matters: times and frequencies are up to 4 % off, and the serial port may not be understood",
                GoesOn, Restart;

            48 PANIC: "panic (a fault of this program?)",
                "keep the line below it and report it",
                AllOff, Restart;
            49 HARD_FAULT: "hard fault (a fault of this program; a supply that dips?)",
                "keep the line below it and report it",
                AllOff, Restart;
            50 CLOCK_STOPPED: "the clock stopped (USB hub switched off; ST-LINK restarted?)",
                "another port or cable",
                AllOff, Restart;
            51 STRAY_INTERRUPT: "an interrupt without a handler (a fault of this program; memory that has lost a bit?)",
                "keep the line below it and report it",
                AllOff, Restart;
            52 WATCHDOG: "reset by the watchdog (a fault logged before the reset; otherwise tick or idle stood still?)",
                "the line before it; if there is none, stop it with a debugger where it stands still",
                AllOff, Restart;
            53 SUPPLY: "the supply dipped (USB port or cable too weak; motors on the board's supply; a short?)",
                "the board's 3.3 V with an oscilloscope while the motors start",
                AllOff, Restart;
            54 STACK_OVERFLOW: "the stack has no room left (a fault of this program; a bit of the stack pointer that has changed?)",
                "report it, with the scene",
                AllOff, Restart;
            55 SETTINGS: "the settings in RAM are damaged (a flipped bit; a fault of this program?)",
                "if it comes again, report it",
                AllOff, Restart;
            56 MODEL: "the model is damaged (flashing was interrupted; flash worn out; a flipped bit in the classifier's RAM?)",
                "if it comes again, flash again",
                AllOff, Restart;
            57 NO_CLOCK: "a clock did not start (solder bridges; ST-LINK cut off?)",
                "the bridges in [build.md](build.md#when-the-program-itself-fails)",
                AllOff, Restart;
            58 SUPPLY_LOW: "the supply is too low for the clock (USB port or cable too weak; motors on the board's supply; a short?)",
                "the board's 3.3 V with an oscilloscope while the motors start",
                AllOff, Restart;
            59 TOO_MANY_RESETS: "three resets in a minute (a supply or a reset line with a loose contact; somebody at the button?)",
                "the lines before it",
                NotArmed, Armed;
            60 TWIN: "another board of the head has its number (two boards with the same jumpers; a jumper without contact?)",
                "[the jumpers](boards.md#the-bus-of-a-head) of both; this board is silent, and its motors stay off",
                NotArmed, Restart;
        }
    };
}
