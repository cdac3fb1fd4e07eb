//! The fields that say which axes are measured and how far they reach.

field! {
    /// The axes that the angle is computed from.
    pub enum AnglePair at 14, mask 0xC000 {
        /// None: no angle.
        #[default]
        Off = 0,
        /// X and Y.
        Xy = 1,
        /// Y and Z.
        Yz = 2,
        /// X and Z.
        Xz = 3,
    }
}

field! {
    /// The axes that are measured, in this order. An axis that comes twice has its two
    /// conversions about the same moment as the others between them.
    pub enum Channels at 6, mask 0x03C0 {
        /// None.
        #[default]
        Off = 0,
        /// X.
        X = 1,
        /// Y.
        Y = 2,
        /// X, Y.
        Xy = 3,
        /// Z.
        Z = 4,
        /// Z, X.
        Zx = 5,
        /// Y, Z.
        Yz = 6,
        /// X, Y, Z.
        Xyz = 7,
        /// X, Y, X.
        Xyx = 8,
        /// Y, X, Y.
        Yxy = 9,
        /// Y, Z, Y.
        Yzy = 10,
        /// Z, Y, Z.
        Zyz = 11,
        /// Z, X, Z.
        Zxz = 12,
        /// X, Z, X.
        Xzx = 13,
        /// X, Y, Z, Y, X.
        Xyzyx = 14,
        /// X, Y, Z, Z, Y, X.
        Xyzzyx = 15,
    }
}

impl Channels {
    /// Whether X, Y and Z are measured.
    pub const fn axes(self) -> [bool; 3] {
        use Channels::{
            Off, X, Xy, Xyx, Xyz, Xyzyx, Xyzzyx, Xzx, Y, Yxy, Yz, Yzy, Z, Zx, Zxz, Zyz,
        };
        match self {
            Off => [false; 3],
            X => [true, false, false],
            Y => [false, true, false],
            Z => [false, false, true],
            Xy | Xyx | Yxy => [true, true, false],
            Zx | Zxz | Xzx => [true, false, true],
            Yz | Yzy | Zyz => [false, true, true],
            Xyz | Xyzyx | Xyzzyx => [true; 3],
        }
    }

    /// Measurements a set, 0 to 6.
    pub const fn count(self) -> u32 {
        use Channels::{Off, X, Xy, Xyzyx, Xyzzyx, Y, Yz, Z, Zx};
        match self {
            Off => 0,
            X | Y | Z => 1,
            Xy | Zx | Yz => 2,
            Xyzyx => 5,
            Xyzzyx => 6,
            // Xyz, and the six that measure one of two axes twice.
            _ => 3,
        }
    }
}

field! {
    /// How far an axis reaches, which depends on the [`Version`] of the part. The title page
    /// of SBASAF4 has the same figures; for the A2, brain113's crate has ±200 mT and ±133 mT
    /// in place of ±150 mT and ±75 mT, from an earlier data sheet.
    pub enum Range at 0, mask 0x0003 {
        /// ±50 mT (A1), ±150 mT (A2).
        #[default]
        Middle = 0,
        /// ±25 mT (A1), ±75 mT (A2).
        Narrow = 1,
        /// ±100 mT (A1), ±300 mT (A2).
        Wide = 2,
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

field! {
    /// Which of the two parts it is, in [`TestConfig`](crate::Register::TestConfig).
    pub enum Version at 4, mask 0x0030 {
        /// TMAG5170A1: up to ±100 mT.
        #[default]
        A1 = 0,
        /// TMAG5170A2: up to ±300 mT.
        A2 = 1,
    }
}
