//! What the fields of the settings may hold.

/// Fields of registers: lowest bit, mask, and the values that stand for 0, 1, 2 and so on. The
/// first value is the one of a reset.
macro_rules! fields {
    ($(
        $(#[$about:meta])*
        $name:ident at $shift:literal, mask $mask:literal {
            $first:ident $(= $first_about:literal)?,
            $($value:ident $(= $value_about:literal)?),+ $(,)?
        }
    )+) => {$(
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[allow(missing_docs, reason = "names say what they stand for where nothing else does")]
        #[repr(u16)]
        pub enum $name {
            #[default]
            $(#[doc = $first_about])?
            $first,
            $($(#[doc = $value_about])? $value,)+
        }

        impl $name {
            /// Every value, in the order of their bits.
            pub const ALL: &[$name] = &[$name::$first, $($name::$value,)+];

            /// In its place in the register.
            pub const fn bits(self) -> u16 {
                (self as u16) << $shift
            }

            /// The value that a register holds; `None` if it is none of these.
            pub fn of(register: u16) -> Option<$name> {
                let place = usize::from((register & $mask) >> $shift);
                $name::ALL.get(place).copied()
            }
        }
    )+};
}

fields! {
    /// Conversions of an axis an average; one alone has twelve bits. More of them: less noise,
    /// more time ([`conversion_time_us`](crate::timing::conversion_time_us)).
    Average at 12, mask 0x7000 {
        X1, X2, X4, X8, X16, X32,
    }

    /// The magnet's loss of field with temperature, which the sensor makes good.
    MagnetType at 8, mask 0x0300 {
        None = "None.",
        Neodymium = "0.12 % a degree: neodymium.",
        SamariumCobalt = "0.03 % a degree: samarium-cobalt. brain113's crate does not have it.",
        Ferrite = "0.2 % a degree: ferrite.",
    }

    /// When the sensor measures.
    OperatingMode at 4, mask 0x0070 {
        Configuration = "Settings may be changed; a trigger starts a conversion, slowly.",
        Standby = "Waits for a trigger.",
        Active = "Measures one set after the other.",
        Triggered = "Waits for a trigger with everything switched on.",
        WakeAndSleep = "Measures now and then by itself.",
        Sleep = "Keeps settings and the last results.",
        DeepSleep = "Forgets its settings.",
    }

    /// The axes that the angle is computed from; [`AnglePair::Off`]: no angle.
    AnglePair at 14, mask 0xC000 {
        Off, Xy, Yz, Xz,
    }

    /// Time between wake-ups, in milliseconds.
    SleepTime at 10, mask 0x3C00 {
        Ms1, Ms5, Ms10, Ms15, Ms20, Ms30, Ms50, Ms100, Ms500, Ms1000,
    }

    /// The axes that are measured, in the order of the name. An axis that comes twice has its
    /// two conversions about the same moment as the others between them.
    Channels at 6, mask 0x03C0 {
        Off, X, Y, Xy, Z, Zx, Yz, Xyz,
        Xyx, Yxy, Yzy, Zyz, Zxz, Xzx, Xyzyx, Xyzzyx,
    }

    /// How far an axis reaches, which depends on the [`Version`] of the part. The title page
    /// of SBASAF4 has the same figures; for the A2, brain113's crate has ±200 mT and ±133 mT
    /// in place of ±150 mT and ±75 mT, from an earlier data sheet.
    Range at 0, mask 0x0003 {
        Middle = "±50 mT (A1), ±150 mT (A2).",
        Narrow = "±25 mT (A1), ±75 mT (A2).",
        Wide = "±100 mT (A1), ±300 mT (A2).",
    }

    /// What starts a conversion in the modes that wait for one.
    Trigger at 9, mask 0x0600 {
        Command = "CMD0 of a frame.",
        ChipSelect = "A pulse on /CS.",
        Alert = "A pulse on ALERT.",
    }

    /// Which of the two parts it is, in [`TestConfig`](crate::Register::TestConfig).
    Version at 4, mask 0x0030 {
        A1 = "TMAG5170A1: up to ±100 mT.",
        A2 = "TMAG5170A2: up to ±300 mT.",
    }
}

impl Average {
    /// How many conversions, 1 to 32.
    pub const fn count(self) -> u32 {
        1 << self as u16
    }
}

impl Channels {
    /// Whether X, Y and Z are measured.
    pub const fn axes(self) -> [bool; 3] {
        // Where no axis comes twice, each has a bit.
        let once = match self {
            Channels::Xyx | Channels::Yxy => Channels::Xy,
            Channels::Yzy | Channels::Zyz => Channels::Yz,
            Channels::Zxz | Channels::Xzx => Channels::Zx,
            Channels::Xyzyx | Channels::Xyzzyx => Channels::Xyz,
            once => once,
        } as u16;
        [once & 1 != 0, once & 2 != 0, once & 4 != 0]
    }

    /// Measurements a set, 0 to 6.
    pub const fn count(self) -> u32 {
        match self as u16 {
            axes @ ..8 => axes.count_ones(),
            8..14 => 3,
            14 => 5,
            _ => 6,
        }
    }
}

impl Range {
    /// Full scale, in millitesla.
    pub const fn full_scale_mt(self, version: Version) -> f32 {
        let a1 = match self {
            Range::Middle => 50.0,
            Range::Narrow => 25.0,
            Range::Wide => 100.0,
        };
        match version {
            Version::A1 => a1,
            Version::A2 => 3.0 * a1,
        }
    }
}

/// Checks of the analogue part, whose findings are [`StatusFaults`](crate::StatusFaults): the
/// sensor's own switch (DIAG_EN) and its choice (DIAG_SEL) in one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Diagnostics {
    /// None.
    #[default]
    Off = 0x0000,
    /// All of them at once.
    All = 0x0020,
    /// Those of the enabled channels at once.
    Enabled = 0x1020,
    /// All of them, one a set of conversions.
    AllInTurn = 0x2020,
    /// Those of the enabled channels, one a set of conversions.
    EnabledInTurn = 0x3020,
}

impl Diagnostics {
    /// In its place in the register.
    pub const fn bits(self) -> u16 {
        self as u16
    }
}
