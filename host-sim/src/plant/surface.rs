//! Surfaces: what their textures are made of, and the profile that a tip travels over.

use scene::Texture;

use physics::Noise;

/// What a surface is to the tip of a whisker.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceSettings {
    /// Root mean square of the profile's height.
    pub(super) height_m: f64,
    /// Distance over which heights are alike: their correlation falls as exp(−distance/grain).
    pub(super) grain_m: f64,
    /// How far a grain holds the tip back along the surface, in its heights. A tip that meets a
    /// hard grain at the angle β is held until it has been bent back by cot β heights.
    pub(super) grip: f64,
    /// How far the surface gives way, relative to the whisker's tip.
    pub(super) softness: f64,
    /// Kinetic friction coefficient μ against the tip.
    pub(super) friction: f64,
}

impl SurfaceSettings {
    /// The surface of a texture of a scene.
    ///
    /// From sources: the grains of P600 and P240, 25.8 µm and 58.5 µm, are the mean particle
    /// diameters of those FEPA grades (ISO 6344; BIOTACT table I). All else is a choice. Abrasive
    /// particles stand half sunk in resin: height a third of the diameter; grip 20 is a whisker at
    /// 2.9°, nearly flat. A carpet's loops are 2.5 mm apart and about 1 mm high (0.3 mm root mean
    /// square), hold the tip by about their own width and give way as much as the tip does.
    /// Friction is of the order of plastic on plastic, on fine and coarse abrasive, and on fibre.
    pub(super) const fn of(texture: Texture) -> Self {
        // Height, grain, grip, softness, friction.
        let [height_m, grain_m, grip, softness, friction] = match texture {
            Texture::P600 => [8.6e-6, 25.8e-6, 20.0, 0.0, 0.4],
            Texture::P240 => [19.5e-6, 58.5e-6, 20.0, 0.0, 0.7],
            Texture::Carpet => [0.3e-3, 2.5e-3, 5.0, 1.0, 0.3],
            // Scenes present no other ([`Texture::is_simple`]).
            _ => [1e-6, 20e-6, 20.0, 0.0, 0.15],
        };
        Self {
            height_m,
            grain_m,
            grip,
            softness,
            friction,
        }
    }
}

/// Height along a path, in units of its root mean square: a stationary Gaussian
/// process with correlation exp(−distance/grain) (Ornstein and Uhlenbeck).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Profile {
    height: f64,
}

/// A way over a surface: what [`Profile::travel`] needs of its d grains. All profiles that
/// travel it share them.
pub(super) struct Path {
    /// d.
    grains: f64,
    /// e^−d, and 1 less that.
    decay: f64,
    lost: f64,
    /// Deviation of the end, and of the mean times d what is shared with the end and its own.
    end: f64,
    shared: f64,
    own: f64,
}

impl Path {
    /// For a distance of `d` grains; 0 or less is none.
    pub(super) fn new(d: f64) -> Self {
        let lost = -libm::expm1(-d);
        let decay = 1.0 - lost;
        let end = (lost * (1.0 + decay)).sqrt();
        let shared = lost * lost / end;
        let own = (spread(d, lost) - shared * shared).max(0.0).sqrt();
        Self {
            grains: d,
            decay,
            lost,
            end,
            shared,
            own,
        }
    }
}

/// 2 d − 3 + 4 e^−d − e^−2d, `lost` being 1 − e^−d.
fn spread(d: f64, lost: f64) -> f64 {
    // 2 d − 2 l − l², l = 1 − e^−d, cancels to 2/3 d³.
    if d < 2e-3 {
        d * d * d * (2.0 / 3.0 - d / 2.0 + 7.0 / 30.0 * d * d)
    } else {
        2.0 * d - lost * (2.0 + lost)
    }
}

impl Profile {
    /// A place that has nothing to do with the last.
    pub(super) fn land(&mut self, noise: &mut Noise) {
        self.height = noise.next();
    }

    /// Travels on and returns the mean height on the way.
    ///
    /// End and mean are drawn from their exact joint distribution. With d grains, a = e^−d and the
    /// height h before: end a h with variance 1 − a², mean times d: (1 − a) h with variance
    /// 2 d − 3 + 4 a − a² and covariance (1 − a)² with the end. So the sum of means does not depend
    /// on how a way is cut into steps.
    pub(super) fn travel(&mut self, path: &Path, noise: &mut Noise) -> f64 {
        if path.grains <= 0.0 {
            return self.height;
        }
        let (first, second) = (noise.next(), noise.next());
        let area = path.lost * self.height + path.shared * first + path.own * second;
        self.height = path.decay * self.height + path.end * first;
        area / path.grains
    }
}

#[cfg(test)]
mod tests {
    use super::{Noise, Path, Profile, SurfaceSettings};
    use scene::Texture;

    #[test]
    fn abrasives_have_the_grains_of_biotact_s_table() {
        assert_eq!(SurfaceSettings::of(Texture::P240).grain_m, 58.5e-6);
        assert_eq!(SurfaceSettings::of(Texture::P600).grain_m, 25.8e-6);
    }

    #[test]
    fn the_series_meets_the_closed_form() {
        for d in [1.999e-3, 2.001e-3] {
            let truth = d * d * d * (2.0 / 3.0 - d / 2.0 + 7.0 / 30.0 * d * d - d * d * d / 12.0);
            let found = super::spread(d, -libm::expm1(-d));
            assert!((found / truth - 1.0).abs() < 1e-8, "{d}");
        }
    }

    /// Variance of the height, and of the mean height over 3 grains, for steps of 3/n grains.
    fn variances(n: u32) -> [f64; 2] {
        let mut noise = Noise::new(9);
        let mut profile = Profile::default();
        let trials = 40_000;
        let (mut end, mut mean) = (0.0, 0.0);
        for _ in 0..trials {
            profile.land(&mut noise);
            let way = (0..n).map(|_| profile.travel(&Path::new(3.0 / f64::from(n)), &mut noise));
            let over = way.sum::<f64>() / f64::from(n);
            mean += over * over / f64::from(trials);
            end += profile.height * profile.height / f64::from(trials);
        }
        [end, mean]
    }

    #[test]
    fn the_profile_does_not_depend_on_the_steps() {
        // ∫∫ e^−|s − t| over a square of side 3, over 9: 2 (3 − 1 + e^−3)/9.
        let expected = [1.0, 2.0 * (2.0 + (-3.0_f64).exp()) / 9.0];
        for n in [1, 4, 600] {
            for (found, expected) in variances(n).into_iter().zip(expected) {
                // A variance from 40,000 trials has a relative error of 0.7 %.
                assert!(
                    (found / expected - 1.0).abs() < 0.03,
                    "{n}: {found} {expected}"
                );
            }
        }
    }
}
