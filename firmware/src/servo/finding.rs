//! How a servo finds where its whisker is: when it looks for home, and what it does there.

use whisking::motor::{self, Duty, Homed, MotorDriver};
use whisking::{Real, Voted};

use super::{Servo, ServoConfig, ServoState};
use crate::io::AngleInput;

impl<R: Real, M: MotorDriver, A: AngleInput> Servo<R, M, A> {
    /// Finds rest again, where it is found; a motor that rests after a fault rests on.
    pub fn home(&mut self) {
        self.off();
        self.is_homed = false;
    }

    /// The same where the home that was found is no more to be compared with.
    pub(crate) fn forget_home(&mut self) {
        self.home();
        self.is_known = false;
    }

    /// Looks for home again where it was found long ago: in the air, or where a whisker that feels
    /// so much contact has not been there for as long again.
    #[inline]
    pub(crate) fn check_home(&mut self, config: &ServoConfig<R>, felt: R) {
        let Some(how) = config.homing() else {
            return;
        };
        if let ServoState::Running { .. } = self.state {
            self.since_home = self.since_home.saturating_add(1);
            let is_calm = felt.to_q24() < how.calm;
            self.calm = if is_calm {
                self.calm.saturating_add(1)
            } else {
                0
            };
            let is_due = self.since_home > how.every && self.calm >= how.still;
            if is_due || self.since_home > how.every.saturating_mul(2) {
                self.home();
            }
        }
    }

    /// One tick of homing: what is to be driven; nothing where it is at home.
    #[cold]
    pub(super) fn find_home(
        &mut self,
        config: &ServoConfig<R>,
        moved: i32,
    ) -> Result<Option<Duty>, motor::Fault> {
        let (ServoState::Homing(homing), Some(how)) = (&mut self.state, config.homing()) else {
            return Ok(None);
        };
        match homing.step(how, &config.guards, self.counts, moved)? {
            Homed::Not(duty) => Ok(Some(duty)),
            Homed::At(home) => {
                self.home = Voted::new(home);
                self.is_homed = true;
                self.is_known = true;
                self.since_home = 0;
                self.off();
                Ok(None)
            }
        }
    }
}
