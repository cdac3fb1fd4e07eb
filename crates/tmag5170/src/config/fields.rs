//! What the fields of the settings may hold, but for the axes.

field! {
    /// Conversions of an axis an average. More of them: less noise, more time
    /// ([`conversion_time_us`](crate::timing::conversion_time_us)).
    pub enum Average at 12, mask 0x7000 {
        /// One: twelve bits.
        #[default]
        X1 = 0,
        /// Two.
        X2 = 1,
        /// Four.
        X4 = 2,
        /// Eight.
        X8 = 3,
        /// Sixteen.
        X16 = 4,
        /// Thirty-two.
        X32 = 5,
    }
}

impl Average {
    /// How many conversions, 1 to 32.
    pub const fn count(self) -> u32 {
        1 << self as u16
    }
}

field! {
    /// The magnet's loss of field with temperature, which the sensor makes good.
    pub enum MagnetType at 8, mask 0x0300 {
        /// None.
        #[default]
        None = 0,
        /// 0.12 % a degree: neodymium.
        Neodymium = 1,
        /// 0.03 % a degree: samarium-cobalt. brain113's crate does not have it.
        SamariumCobalt = 2,
        /// 0.2 % a degree: ferrite.
        Ferrite = 3,
    }
}

field! {
    /// When the sensor measures.
    pub enum OperatingMode at 4, mask 0x0070 {
        /// Settings may be changed; a trigger starts a conversion, slowly.
        #[default]
        Configuration = 0,
        /// Waits for a trigger.
        Standby = 1,
        /// Measures one set after the other.
        Active = 2,
        /// Waits for a trigger with everything switched on.
        Triggered = 3,
        /// Measures now and then by itself.
        WakeAndSleep = 4,
        /// Keeps settings and the last results.
        Sleep = 5,
        /// Forgets its settings.
        DeepSleep = 6,
    }
}

field! {
    /// Time between wake-ups.
    pub enum SleepTime at 10, mask 0x3C00 {
        /// 1 ms.
        #[default]
        Ms1 = 0,
        /// 5 ms.
        Ms5 = 1,
        /// 10 ms.
        Ms10 = 2,
        /// 15 ms.
        Ms15 = 3,
        /// 20 ms.
        Ms20 = 4,
        /// 30 ms.
        Ms30 = 5,
        /// 50 ms.
        Ms50 = 6,
        /// 100 ms.
        Ms100 = 7,
        /// 500 ms.
        Ms500 = 8,
        /// 1 s.
        Ms1000 = 9,
    }
}

field! {
    /// What starts a conversion in the modes that wait for one.
    pub enum Trigger at 9, mask 0x0600 {
        /// CMD0 of a frame.
        #[default]
        Command = 0,
        /// A pulse on /CS.
        ChipSelect = 1,
        /// A pulse on ALERT.
        Alert = 2,
    }
}

field! {
    /// What a reply carries: a register, or twelve bits of each of two channels.
    pub enum DataType at 6, mask 0x01C0 {
        /// The register asked for.
        #[default]
        Register = 0,
        /// X, then Y.
        Xy = 1,
        /// X, then Z.
        Xz = 2,
        /// Z, then Y.
        Zy = 3,
        /// X, then temperature.
        Xt = 4,
        /// Y, then temperature.
        Yt = 5,
        /// Z, then temperature.
        Zt = 6,
        /// Angle, then magnitude.
        AngleMagnitude = 7,
    }
}

field! {
    /// What kind of pin ALERT is.
    pub enum AlertMode at 12, mask 0x1000 {
        /// An interrupt, or the trigger of conversions.
        #[default]
        Interrupt = 0,
        /// A switch that follows the thresholds.
        Switch = 1,
    }
}

/// Checks of the analogue part, whose findings are [`StatusFaults`](crate::StatusFaults): the sensor's
/// own switch (DIAG_EN) and its choice (DIAG_SEL) in one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Diagnostics {
    /// None.
    #[default]
    Off,
    /// All of them at once.
    All,
    /// Those of the enabled channels at once.
    Enabled,
    /// All of them, one a set of conversions.
    AllInTurn,
    /// Those of the enabled channels, one a set of conversions.
    EnabledInTurn,
}

impl Diagnostics {
    /// In its place in the register.
    #[inline]
    pub const fn bits(self) -> u16 {
        match self {
            Diagnostics::Off => 0x0000,
            Diagnostics::All => 0x0020,
            Diagnostics::Enabled => 0x1020,
            Diagnostics::AllInTurn => 0x2020,
            Diagnostics::EnabledInTurn => 0x3020,
        }
    }
}
