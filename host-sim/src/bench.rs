//! A module of any shape behind one interface: the firmware's [`Module`] on
//! mock hardware.

use std::cell::Cell;
use std::rc::Rc;

use firmware::design_parameters::{RETRY_S, hold_limits, stall, ticks};
use firmware::{
    Active, ActiveConfig, AngleInput, Classifying, ClassifyingConfig, Clock, Config, Event, Module,
    Polled, SampleClassifier, Servo,
};
use mlx90333::{Decoder, Mlx90333};
use scene::{Numbers, Scene};
use tactile::Decision;
use whisking::motor::{Duty, Fault, MotorDriver};
use whisking::{Fix, Real, filter};

use crate::Error;
use crate::bus::{SimSpi, Slave};

/// Any motor driver.
pub struct AnyMotor(pub Box<dyn MotorDriver>);

impl MotorDriver for AnyMotor {
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        self.0.drive(duty)
    }

    fn off(&mut self) {
        self.0.off();
    }

    fn clear(&mut self) {
        self.0.clear();
    }
}

/// Any angle input.
pub struct AnyAngle(pub Box<dyn AngleInput>);

impl AngleInput for AnyAngle {
    fn counts(&mut self) -> i32 {
        self.0.counts()
    }
}

/// Any classifier of one whisker.
pub struct AnyListener<'m>(pub Box<dyn SampleClassifier + 'm>);

impl SampleClassifier for AnyListener<'_> {
    fn push(&mut self, codes: [u16; 2]) -> Option<Decision> {
        self.0.push(codes)
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

/// A motor that is wherever it should be: the plant says where. For the plant
/// `ideal`, in which the angle is θ' exactly.
#[derive(Debug, Clone, Default)]
pub struct IdealMotor {
    angle_deg: Rc<Cell<f64>>,
    counts_per_deg: f64,
}

impl IdealMotor {
    /// A motor at rest whose angle input has `counts_per_deg` counts a degree.
    pub fn new(counts_per_deg: f64) -> Self {
        Self {
            angle_deg: Rc::new(Cell::new(whisking::REST_DEG)),
            counts_per_deg,
        }
    }

    /// Moves it.
    pub fn set_deg(&self, angle_deg: f64) {
        self.angle_deg.set(angle_deg);
    }
}

impl MotorDriver for IdealMotor {
    fn drive(&mut self, _duty: Duty) -> Result<(), Fault> {
        Ok(())
    }

    fn off(&mut self) {}

    fn clear(&mut self) {}
}

impl AngleInput for IdealMotor {
    fn counts(&mut self) -> i32 {
        ((self.angle_deg.get() - whisking::REST_DEG) * self.counts_per_deg).round() as i32
    }
}

/// Time does not pass within a tick of the simulation.
#[derive(Debug, Clone, Copy)]
struct NoClock;

impl Clock for NoClock {
    fn now(&mut self) -> u32 {
        0
    }
}

/// What a module shows of itself after a tick. Values of a side that is not
/// there are not a number.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// θ' of every whisker, left side first, degrees.
    pub theta_deg: Vec<f64>,
    /// z of each side.
    pub z: [f64; 2],
    /// g of the first whisker of each side.
    pub g: [f64; 2],
    /// Contact π of each side.
    pub contact: [f64; 2],
}

/// A module as a run sees it.
pub trait Bench {
    /// One tick.
    fn tick(&mut self, events: &mut Vec<Event>);

    /// Fills in `snapshot`; `theta_deg` has a place for every whisker.
    fn look(&self, snapshot: &mut Snapshot);

    /// Makes the classifier forget its evidence.
    fn forget(&mut self);
}

type HostModule<'m, R, const S: usize, const N: usize> = Module<
    R,
    Polled<SimSpi>,
    Option<Active<R, AnyMotor, AnyAngle, S, N>>,
    Option<Classifying<AnyListener<'m>>>,
    NoClock,
    S,
    N,
>;

struct Shaped<'m, R: Real, const S: usize, const N: usize> {
    module: HostModule<'m, R, S, N>,
    config: Config<R, Option<ActiveConfig<R>>, Option<ClassifyingConfig<R>>>,
}

impl<R: Real, const S: usize, const N: usize> Bench for Shaped<'_, R, S, N> {
    fn tick(&mut self, events: &mut Vec<Event>) {
        self.module
            .tick(&self.config, &mut |event| events.push(event));
    }

    fn look(&self, snapshot: &mut Snapshot) {
        for (place, pi) in snapshot.contact.iter_mut().zip(self.module.contact()) {
            *place = pi.to_f64();
        }
        let Some(active) = self.module.motion() else {
            return;
        };
        let state = active.state();
        let theta = state.theta();
        for (place, theta) in snapshot.theta_deg.iter_mut().zip(theta.iter().flatten()) {
            *place = whisking::degrees(theta.to_f64());
        }
        for (place, z) in snapshot.z.iter_mut().zip(state.z) {
            *place = z.value.to_f64();
        }
        for (place, whiskers) in snapshot.g.iter_mut().zip(&state.whiskers) {
            *place = whiskers.first().map_or(f64::NAN, whisking::Whisker::gain);
        }
    }

    fn forget(&mut self) {
        if let Some(touch) = self.module.perception_mut() {
            touch.classifier_mut().reset();
        }
    }
}

/// What a module is made of besides its scene.
pub struct Parts<'m> {
    /// The sensor of every whisker, left side first.
    pub slaves: Vec<Slave>,
    /// The motor and angle input of every whisker, left side first; none where
    /// the whiskers are passive.
    pub drives: Vec<(AnyMotor, AnyAngle)>,
    /// What listens to the first whisker.
    pub listener: Option<AnyListener<'m>>,
}

/// Makes the module of `scene`.
///
/// # Errors
/// [`Error::Work`] if the parts do not fit the scene.
pub fn build<'m>(scene: &Scene, parts: Parts<'m>) -> Result<Box<dyn Bench + 'm>, Error> {
    match scene.whisking.as_ref().map(|whisking| whisking.numbers) {
        Some(Numbers::Double) => sized::<f64>(scene, parts),
        Some(Numbers::Fixed) => sized::<Fix>(scene, parts),
        _ => sized::<f32>(scene, parts),
    }
}

fn sized<'m, R: Real>(scene: &Scene, parts: Parts<'m>) -> Result<Box<dyn Bench + 'm>, Error> {
    macro_rules! shapes {
        ($($n:literal)*) => {
            match (scene.head.sides.count(), scene.head.whiskers_per_side) {
                $(
                    (1, $n) => shaped::<R, 1, $n>(scene, parts),
                    (2, $n) => shaped::<R, 2, $n>(scene, parts),
                )*
                (sides, whiskers) => {
                    Err(Error::Work(format!("no module of {sides} sides with {whiskers} whiskers")))
                }
            }
        };
    }
    shapes!(1 2 3 4 5 6 7 8 9 10 11 12)
}

fn shaped<'m, R: Real, const S: usize, const N: usize>(
    scene: &Scene,
    parts: Parts<'m>,
) -> Result<Box<dyn Bench + 'm>, Error> {
    let misfit = |what: &str| Error::Work(format!("the module's {what} do not fit the scene"));
    let broken = |mismatch: plan::Mismatch| match mismatch {
        plan::Mismatch::Unstable(unstable) => Error::Input(unstable.to_string()),
        mismatch => Error::Work(mismatch.to_string()),
    };
    let tick_hz = f64::from(scene.tick_hz);

    let plan = plan::motion::<R, S, N>(scene).map_err(broken)?;
    let mut drives = parts.drives.into_iter();
    let motion = match &plan {
        None => None,
        Some(plan) => {
            let stall = stall(scene.tick_hz, plan.stall_q15);
            let servos = array(|| {
                let (motor, angle) = drives.next()?;
                Some(Servo::new(motor, angle, stall))
            })
            .ok_or_else(|| misfit("motors"))?;
            Some(Active::new(
                whisking::State::new(&plan.start, scene.seed),
                servos,
            ))
        }
    };

    let mut slaves = parts.slaves.iter();
    let sensors = array(|| {
        Some(Polled::new(Mlx90333::new(
            slaves.next()?.spi(),
            Decoder::new(),
        )))
    })
    .ok_or_else(|| misfit("sensors"))?;

    // The trace shows contact wherever there is something to touch.
    let contact = match plan::contact(scene).map_err(broken)? {
        None if scene.plant.obstacle.is_some() => {
            let h50 = filter::Config::new(filter::CORNER_HZ, tick_hz);
            Some(h50.map_err(|error| Error::Work(error.to_string()))?)
        }
        contact => contact,
    };
    let contact_min = scene.classifier.as_ref().and_then(|c| c.contact_min);
    let config = Config {
        decoder: Decoder::new(),
        hold_limits: hold_limits(scene.tick_hz),
        contact,
        motion: plan.map(|plan| ActiveConfig {
            whisking: plan.whisking,
            pd: plan.pd,
            retry: ticks(RETRY_S, scene.tick_hz),
            stall: stall(scene.tick_hz, plan.stall_q15),
        }),
        perception: parts.listener.is_some().then(|| ClassifyingConfig {
            contact_min: contact_min.map(R::from_f64),
        }),
        period: 0,
    };
    let module = Module::new(
        sensors,
        motion,
        parts.listener.map(Classifying::new),
        NoClock,
    );
    Ok(Box::new(Shaped { module, config }))
}

/// S × N things, or `None` if `make` runs out of them.
fn array<T, const S: usize, const N: usize>(
    mut make: impl FnMut() -> Option<T>,
) -> Option<[[T; N]; S]> {
    let mut sides = Vec::with_capacity(S);
    for _ in 0..S {
        let side: Vec<T> = (0..N).map_while(|_| make()).collect();
        sides.push(<[T; N]>::try_from(side).ok()?);
    }
    <[[T; N]; S]>::try_from(sides).ok()
}
