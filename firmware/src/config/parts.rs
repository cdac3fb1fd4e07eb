//! The parts that an image may be built without.

use crate::numbered::numbered;

macro_rules! parts {
    (@built "") => { true };
    (@built $feature:tt) => { cfg!(feature = $feature) };
    ($($name:ident $feature:tt = $code:literal: $text:literal;)*) => {
        numbered! {
            /// A part of a configuration. Numbers keep their meanings.
            Part: $($name = $code: $text;)*
        }

        impl Part {
            /// The cargo feature that it is built by; empty: it is always there.
            pub const fn feature(self) -> &'static str {
                match self {
                    $(Self::$name => $feature,)*
                }
            }

            /// Whether this image has it.
            #[inline]
            pub const fn is_built(self) -> bool {
                match self {
                    $(Self::$name => parts!(@built $feature),)*
                }
            }
        }
    };
}

/// Hands every [`Part`], `Name "feature" = number: "text";`, to the macro `$then`.
#[doc(hidden)]
#[macro_export]
macro_rules! config_parts {
    ($then:ident) => {
        $then! {
            Head "" = 0: "head";
            Sensor "" = 1: "sensor";
            Links "" = 2: "links";
            Contact "contact" = 3: "contact";
            Motion "motion" = 4: "motion";
            Rcp "rcp" = 5: "rcp";
            Cia "cia" = 6: "cia";
            Noise "noise" = 7: "noise";
            Euler "euler" = 8: "integrator euler";
            Exact "exact" = 9: "integrator exact";
            HBridge "h-bridge" = 10: "driver h-bridge";
            SixStep "six-step" = 11: "driver six-step";
            Homing "homing" = 12: "homing";
            Classifier "classifier" = 13: "classifier";
            Sequential "sequential" = 14: "rule sequential";
            Window "window" = 15: "rule window";
            Several "several" = 16: "several whiskers that decide";
            Zero "zero" = 17: "zero of the sensor";
            Rtt "rtt" = 18: "link rtt";
            Serial "serial" = 19: "link serial";
            Pins "pins" = 20: "pins";
            Set "set" = 21: "settings by command";
            Deploy "deploy" = 22: "deployment by command";
            Mlx90333 "mlx90333" = 23: "sensor mlx90333";
            Tmag5170 "tmag5170" = 24: "sensor tmag5170";
            SelfMotion "self-motion" = 25: "self-motion of the sensor";
            Priors "priors" = 26: "priors or thresholds of classes";
            Bus "bus" = 27: "bus";
            Pose "pose" = 28: "pose of what is named";
        }
    };
}
config_parts!(parts);

impl Part {
    /// Whether an image takes configurations over its links. One that does not runs by
    /// the one that it was linked with: whoever made that has checked it, by the same
    /// functions, and its sum says whether it is still what it was.
    pub const TAKES_CONFIGURATIONS: bool = Self::Deploy.is_built() || Self::Set.is_built();
}
