//! A configuration as Rust source, for build scripts (feature `bake`).
//!
//! Every type of a configuration implements [`databake::Bake`], which gives its
//! value with full paths (`whisking::...`), in any number format: the bounds of
//! [`Real`] and [`Constant`](crate::Constant) include it. [`Config::source`]
//! also turns what a configuration chose at run time into types.

use databake::{Bake, BakeSize, CrateEnv, TokenStream, quote};

use crate::motor::Duty;
use crate::{Config, Real, muscle, oscillator};

/// A type and a value of it as Rust source with full paths.
#[derive(Debug, Clone)]
pub struct Source {
    /// The type.
    pub of_type: TokenStream,
    /// The value, a constant expression.
    pub value: TokenStream,
}

impl Source {
    /// `part` as [`Present`](crate::Present), whose type is `of_type`, or
    /// [`Absent`](crate::Absent).
    pub fn optional(part: Option<&impl Bake>, of_type: &TokenStream, env: &CrateEnv) -> Self {
        match part {
            Some(part) => {
                let value = part.bake(env);
                Self {
                    of_type: quote! { whisking::Present<#of_type> },
                    value: quote! { whisking::Present(#value) },
                }
            }
            None => Self {
                of_type: quote! { whisking::Absent },
                value: quote! { whisking::Absent },
            },
        }
    }
}

impl<R: Real> Config<R> {
    /// This configuration with the parts that it has as types; `number` is the
    /// name of `R` in the source.
    ///
    /// ```
    /// # use databake::{CrateEnv, quote};
    /// # use whisking::{Integrator, Settings};
    /// # let settings = Settings {
    /// #     tick_hz: 2000.0, frequency_hz: 8.0, integrator: Integrator::Exact,
    /// #     coupling: true, noise: 0.0, rcp: None, cia: None,
    /// # };
    /// let config = settings.build::<f32>().unwrap();
    /// let source = config.source(&quote!(f32), &CrateEnv::default());
    /// let (of_type, value) = (source.of_type, source.value);
    /// let constant = quote! { pub const WHISKING: #of_type = #value; };
    /// # assert!(constant.to_string().starts_with("pub const WHISKING : whisking :: Config < f32"));
    /// ```
    pub fn source(&self, number: &TokenStream, env: &CrateEnv) -> Source {
        let (oscillators, oscillators_value) = match &self.oscillators {
            oscillator::Config::Euler(euler) => (quote! { Euler }, euler.bake(env)),
            oscillator::Config::Exact(exact) => (quote! { Exact }, exact.bake(env)),
        };
        let (muscle, muscle_value) = match &self.muscle {
            muscle::Config::Euler(euler) => (quote! { Euler }, euler.bake(env)),
            muscle::Config::Exact(exact) => (quote! { Exact }, exact.bake(env)),
        };
        let rcp_type = quote! { whisking::gate::Rcp<#number> };
        let rcp = Source::optional(self.rcp.as_ref(), &rcp_type, env);
        let cia_type = quote! { whisking::gate::Cia<#number> };
        let cia = Source::optional(self.cia.as_ref(), &cia_type, env);
        let noise_type = quote! { whisking::noise::Config<#number> };
        let noise = Source::optional(self.noise.as_ref(), &noise_type, env);

        let types = [&rcp, &cia, &noise].map(|part| &part.of_type);
        let [rcp, cia, noise] = [&rcp, &cia, &noise].map(|part| &part.value);
        let peak_gain = self.peak_gain.bake(env);
        Source {
            of_type: quote! {
                whisking::Config<
                    #number,
                    whisking::oscillator::#oscillators<#number>,
                    whisking::muscle::#muscle<#number>,
                    #(#types),*
                >
            },
            value: quote! {
                whisking::Config {
                    oscillators: #oscillators_value,
                    muscle: #muscle_value,
                    peak_gain: #peak_gain,
                    rcp: #rcp,
                    cia: #cia,
                    noise: #noise,
                }
            },
        }
    }
}

// Its field is private: not every Q15 integer is a duty.
impl Bake for Duty {
    fn bake(&self, env: &CrateEnv) -> TokenStream {
        env.insert("whisking");
        let q15 = self.q15();
        quote! { whisking::motor::Duty::from_q15(#q15) }
    }
}

impl BakeSize for Duty {
    fn borrows_size(&self) -> usize {
        0
    }
}
