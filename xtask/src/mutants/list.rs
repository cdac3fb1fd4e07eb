//! What is left out or turned round, one at a time.

use crate::run::Fault;

/// One change of the source.
pub(crate) struct Mutant {
    /// What it takes away.
    pub(crate) what: &'static str,
    /// The file, from the top.
    pub(crate) file: &'static str,
    /// What stands there, once.
    is: &'static str,
    /// What is put there.
    becomes: &'static str,
}

impl Mutant {
    /// `text` with the change.
    ///
    /// # Errors
    /// If what it changes is not there exactly once.
    pub(crate) fn applied(&self, text: &str) -> Result<String, Fault> {
        match text.matches(self.is).count() {
            1 => Ok(text.replacen(self.is, self.becomes, 1)),
            n => Err(format!(
                "{}: {n} places and not one for: {}",
                self.file, self.what
            )),
        }
    }
}

const fn mutant(
    what: &'static str,
    file: &'static str,
    is: &'static str,
    becomes: &'static str,
) -> Mutant {
    Mutant {
        what,
        file,
        is,
        becomes,
    }
}

const OSCILLATOR: &str = "crates/whisking/src/oscillator.rs";
const MUSCLE: &str = "crates/whisking/src/muscle.rs";
const GATE: &str = "crates/whisking/src/gate.rs";
const FILTER: &str = "crates/whisking/src/filter.rs";
const FLOAT: &str = "crates/whisking/src/real/float.rs";
const FIX: &str = "crates/whisking/src/real/fix.rs";
const STEP: &str = "crates/whisking/src/step.rs";
const NOISE: &str = "crates/whisking/src/noise.rs";
const START: &str = "crates/whisking/src/start.rs";
const SINGLE: &str = "crates/whisking/src/math/single.rs";
const FIXED: &str = "crates/whisking/src/math/fixed.rs";
const PD: &str = "crates/whisking/src/pd.rs";
const MODULE: &str = "firmware/src/module.rs";

/// Everything that is tried.
#[rustfmt::skip] // One entry, one line.
pub(crate) const LIST: &[Mutant] = &[
    mutant("eq. 3: pull on ψ₁", OSCILLATOR, "(x - a).times(share), (y", "R::ZERO, (y"),
    mutant("eq. 3: pull on ψ₂", OSCILLATOR, "(y - b).times(share)]", "R::ZERO]"),
    mutant("eq. 3: direction of the pull, exact at the origin", OSCILLATOR, "[R::ONE.times(share), R::ZERO]", "[R::ZERO, R::ZERO]"),
    mutant("eq. 3, Euler: rotation of ψ₁", OSCILLATOR, "x - b.times(self.turn) +", "x +"),
    mutant("eq. 3, Euler: rotation of ψ₂", OSCILLATOR, "y + a.times(self.turn),", "y,"),
    mutant("eq. 3, exact: rotation of ψ₁", OSCILLATOR, "[[-couple, -omega], [omega, 0.0]]", "[[-couple, 0.0], [omega, 0.0]]"),
    mutant("eq. 3, exact: rotation of ψ₂", OSCILLATOR, "[[-couple, -omega], [omega, 0.0]]", "[[-couple, -omega], [0.0, 0.0]]"),
    mutant("eq. 3, exact: radial part of ψ₁", OSCILLATOR, "[change[0] + x, change[1] + y]", "[change[0], change[1] + y]"),
    mutant("eq. 3, exact: radial part of ψ₂", OSCILLATOR, "[change[0] + x, change[1] + y]", "[change[0] + x, change[1]]"),
    mutant("eq. 3, exact: linear part before the radial one", OSCILLATOR, "pull([chi[0] + change[0], chi[1] + change[1]], self.relax)", "pull(*chi, self.relax)"),
    mutant("eq. 3, exact: half a tick from χ to ψ", OSCILLATOR, "let x = psi[side][k] + half[side][k];", "let x = psi[side][k];"),
    mutant("eq. 3, exact: half a tick back at the start", OSCILLATOR, "            *x += back;\n", "            let _ = (&x, back);\n"),
    mutant("eq. 4, Euler: the other side's pull", OSCILLATOR, "(other - a).times(self.couple)", "-a.times(self.couple)"),
    mutant("eq. 4, Euler: one's own part of the coupling", OSCILLATOR, "(other - a).times(self.couple)", "other.times(self.couple)"),
    mutant("eq. 4, Euler: coupling", OSCILLATOR, " + (other - a).times(self.couple)", ""),
    mutant("eq. 4, exact: coupling", OSCILLATOR, "2.0 * cycles / TAU_PERIODS", "0.0"),
    mutant("eq. 4, exact: a factor of two in the coupling", OSCILLATOR, "2.0 * cycles / TAU_PERIODS", "cycles / TAU_PERIODS"),
    mutant("eq. 4, exact: what the difference gives to the left", OSCILLATOR, "[s0 + d0, s1 + d1]", "[s0, s1]"),
    mutant("eq. 4, exact: what the difference gives to the right", OSCILLATOR, "[s0 - d0, s1 - d1]", "[s0, s1]"),
    mutant("eq. 4, exact: what the sum gives to a lone side", OSCILLATOR, "[a + a, b + b]", "[a, b]"),
    mutant("eq. 4: which side is the other", OSCILLATOR, "(side + 1) % S", "side"),
    mutant("eq. 5: noise on the oscillators", OSCILLATOR, "change[side][k] + noise[side][k]", "change[side][k]"),
    mutant("eq. 5: scale of the noise with the tick rate", NOISE, " * libm::sqrt(tick_hz / REFERENCE_TICK_HZ)", ""),
    mutant("eq. 5: the quarter that a small format needs", NOISE, "4.0 * sigma / tick_hz", "sigma / tick_hz"),
    mutant("eq. 5: H50 on the noise", NOISE, "self.filter.process(f, white).times", "white.times"),
    mutant("eq. 5: sign of the noise", NOISE, "if word & 1 == 0 { magnitude } else { -magnitude }", "magnitude"),
    mutant("eq. 5: interpolation between quantiles", NOISE, "lo + ((i64::from(hi - lo) * within) >> 24) as i32", "lo"),
    mutant("limit of ψ after a step", OSCILLATOR, "                *x = x.clamp(-R::PSI_LIMIT, R::PSI_LIMIT);\n", ""),
    mutant("limit of ψ where it is read", OSCILLATOR, "psi[side][k] = x.clamp(-R::PSI_LIMIT, R::PSI_LIMIT);", "psi[side][k] = x;"),
    mutant("eq. 6: one half, f64", FLOAT, "0.5 * libm::tanh(2.0 * self) + 0.5", "0.5 * libm::tanh(2.0 * self)"),
    mutant("eq. 6: factor of two, f64", FLOAT, "libm::tanh(2.0 * self)", "libm::tanh(self)"),
    mutant("eq. 6: one half, f32", SINGLE, "x * p / q + 0.5", "x * p / q"),
    mutant("eq. 6: one half, fixed point", FIXED, "one_half + half\n", "half\n"),
    mutant("eq. 6: sign, fixed point", FIXED, "one_half - half\n", "one_half + half\n"),
    mutant("eq. 7, Euler: force", MUSCLE, "let pull = (push - state.theta)", "let pull = (-state.theta)"),
    mutant("eq. 7, Euler: spring", MUSCLE, "let pull = (push - state.theta)", "let pull = push"),
    mutant("eq. 7, Euler: damping", MUSCLE, "velocity + pull - velocity.times(self.damping)", "velocity + pull"),
    mutant("eq. 7, Euler: old velocity", MUSCLE, "velocity + pull - velocity.times(self.damping)", "pull - velocity.times(self.damping)"),
    mutant("eq. 7, Euler: motion", MUSCLE, "            .accumulate(&mut state.carry, velocity.times(self.spring));", "            .accumulate(&mut state.carry, velocity - velocity);"),
    mutant("eq. 7, Euler: velocity before the step", MUSCLE, "            .accumulate(&mut state.carry, velocity.times(self.spring));", "            .accumulate(&mut state.carry, state.velocity.times(self.spring));"),
    mutant("eq. 7, exact: dθ/dt", MUSCLE, "a[0][1] = h;", "a[0][1] = 0.0;"),
    mutant("eq. 7, exact: spring", MUSCLE, "&[-h, -DAMPING * h, h]", "&[0.0, -DAMPING * h, h]"),
    mutant("eq. 7, exact: damping", MUSCLE, "&[-h, -DAMPING * h, h]", "&[-h, 0.0, h]"),
    mutant("eq. 7, exact: force", MUSCLE, "&[-h, -DAMPING * h, h]", "&[-h, -DAMPING * h, 0.0]"),
    mutant("eq. 7, exact: the equilibrium a f", MUSCLE, "(state.theta - gain * f, state.velocity)", "(state.theta, state.velocity)"),
    mutant("eq. 7, exact: θ's part of the propagator", MUSCLE, "            off.times(self.linear[i][0])\n                + velocity", "            velocity"),
    mutant("eq. 7, exact: v's part of the propagator", MUSCLE, "                + velocity.times(self.linear[i][1])\n", ""),
    mutant("eq. 7, exact: predictor, ∇f", MUSCLE, "(d1.times(w1) + d2.times(w2) + d3.times(w3))", "(d2.times(w2) + d3.times(w3) + d1.times(w1) - d1.times(w1))"),
    mutant("eq. 7, exact: predictor, ∇²f", MUSCLE, "(d1.times(w1) + d2.times(w2) + d3.times(w3))", "(d1.times(w1) + d3.times(w3) + d2.times(w2) - d2.times(w2))"),
    mutant("eq. 7, exact: predictor, ∇³f", MUSCLE, "(d1.times(w1) + d2.times(w2) + d3.times(w3))", "(d1.times(w1) + d2.times(w2) + d3.times(w3) - d3.times(w3))"),
    mutant("eq. 7, exact: prediction of θ before the force", MUSCLE, "(state.theta + change[0]).exp_neg_square()", "state.theta.exp_neg_square()"),
    mutant("eq. 7, exact: corrector on θ", MUSCLE, "change[0] + theta)", "change[0])"),
    mutant("eq. 7, exact: corrector on v", MUSCLE, "(change[1] + v)", "change[1]"),
    mutant("eq. 7, exact: ∇³f in the corrector", MUSCLE, "(n3 - d3)", "n3"),
    mutant("eq. 7, exact: history of ∇f", MUSCLE, "[force, n1, n2, n3]", "[force, d1, n2, n3]"),
    mutant("eq. 7, exact: history of ∇²f", MUSCLE, "[force, n1, n2, n3]", "[force, n1, d2, n3]"),
    mutant("eq. 7, exact: history of ∇³f", MUSCLE, "[force, n1, n2, n3]", "[force, n1, n2, d3]"),
    mutant("eq. 7, start: force", MUSCLE, "(push - theta - DAMPING * velocity)", "(-theta - DAMPING * velocity)"),
    mutant("eq. 7, start: spring", MUSCLE, "(push - theta - DAMPING * velocity)", "(push - DAMPING * velocity)"),
    mutant("eq. 7, start: damping", MUSCLE, "(push - theta - DAMPING * velocity)", "(push - theta)"),
    mutant("eq. 7, start: forces before the first tick", START, "*h = self.past(psi, side, *g);", "let _ = (&h, self.past::<R, S>(psi, side, *g));"),
    mutant("limit of θ", MUSCLE, "        state.theta = state.theta.clamp(-R::TWO, R::TWO);\n", ""),
    mutant("limit of v", MUSCLE, "        state.velocity = state.velocity.clamp(-R::TWO, R::TWO);\n", ""),
    mutant("eq. 8: exp(−θ²), Euler", MUSCLE, "(drive * state.theta.exp_neg_square())", "drive"),
    mutant("eq. 8: exp(−θ²), exact", MUSCLE, "drive * (state.theta + change[0]).exp_neg_square()", "drive"),
    mutant("eq. 8: 1 − z", STEP, "self.peak_gain * (R::ONE - state.z[side].value)", "self.peak_gain"),
    mutant("eq. 8: g", STEP, "open * whisker.gain.value", "open"),
    mutant("eq. 8: 1.45", STEP, "self.peak_gain * (R::ONE", "(R::ONE"),
    mutant("eq. 8: drive kept for the next tick (Euler)", STEP, "            state.drive[side] = after;\n", ""),
    mutant("eq. 9: H50 on x", MODULE, ".process(filter, normalised(reading.x))", ".process(filter, normalised(reading.x));\n                *contact = normalised::<R>(reading.x)"),
    mutant("eq. 9: magnitude", MODULE, "                    .abs()\n", ""),
    mutant("eq. 9: largest of the side", MODULE, "                    .max(*contact);", "                    .max(R::ZERO);"),
    mutant("eq. 10: σ_z π", GATE, "pi.times(self.gain), R::ONE", "R::ZERO, R::ONE"),
    mutant("eq. 10: decay of z", GATE, "z.step(R::ZERO, self.decay,", "z.step(z.value, self.decay,"),
    mutant("eqs. 10 and 13: exact decay", GATE, "-libm::expm1(-1.0 / ticks)", "1.0 / ticks"),
    mutant("eqs. 10 and 13: the papers' decay", GATE, "Euler => 1.0 / ticks", "Euler => -libm::expm1(-1.0 / ticks)"),
    mutant("eqs. 10 and 12: the larger of the two", GATE, "self.value.max(floor)", "floor"),
    mutant("eqs. 10 and 12: limits of a gate", GATE, ".max(floor).clamp(R::ZERO, top)", ".max(floor)"),
    mutant("eq. 12: g_nominal", GATE, "nominal + zeta.times(self.gain)", "zeta.times(self.gain)"),
    mutant("eq. 12: σ_g ζ", GATE, "nominal + zeta.times(self.gain)", "nominal"),
    mutant("eq. 13: g_nominal", GATE, "            nominal,\n            self.approach,", "            R::ZERO,\n            self.approach,"),
    mutant("eq. 13: return of g", GATE, "            nominal,\n            self.approach,", "            g.value,\n            self.approach,"),
    mutant("eq. 14: the stronger side", STEP, "zeta, pi| pi.max(zeta)", "_zeta, pi| *pi"),
    mutant("carry of a sum, f32 and f64", FLOAT, "let step = increment + *carry;", "let step = increment;"),
    mutant("carry of a decay, fixed point", FIX, "*carry = way - (step << approach.shift);", "*carry = 0;"),
    mutant("rounding of a product, fixed point", FIX, "(factor.product(self.0) + factor.half())", "factor.product(self.0)"),
    mutant("saturation of a sum, fixed point", FIX, "self.0.saturating_add(other.0)", "self.0.wrapping_add(other.0)"),
    mutant("saturation of a difference, fixed point", FIX, "self.0.saturating_sub(other.0)", "self.0.wrapping_sub(other.0)"),
    mutant("saturation of a product, fixed point", FIX, "Self(saturated((product + (1 << (FRACTION - 1))) >> FRACTION))", "Self(((product + (1 << (FRACTION - 1))) >> FRACTION) as i32)"),
    mutant("H50, first order: new input", FILTER, "(x - state.first).times(self.first)", "(-state.first).times(self.first)"),
    mutant("H50, first order: old state", FILTER, "(x - state.first).times(self.first)", "x.times(self.first)"),
    mutant("H50, first order: trapezoid, output", FILTER, "let y = state.first + half;", "let y = state.first;"),
    mutant("H50, first order: trapezoid, state", FILTER, "state.first = y + half;", "state.first = y;"),
    mutant("H50, second order: feedback of the outer state", FILTER, "let v3 = y - s2;", "let v3 = y;"),
    mutant("H50, second order: into the inner state", FILTER, "let d1 = v3.times(into) - s1.times(leak);", "let d1 = -s1.times(leak);"),
    mutant("H50, second order: leak of the inner state", FILTER, "let d1 = v3.times(into) - s1.times(leak);", "let d1 = v3.times(into);"),
    mutant("H50, second order: from inner to outer", FILTER, "s2 + s1.times(into) + v3.times(through)", "s2 + v3.times(through)"),
    mutant("H50, second order: straight through", FILTER, "s2 + s1.times(into) + v3.times(through)", "s2 + s1.times(into)"),
    mutant("H50, second order: trapezoid, inner state", FILTER, "[s1 + d1 + d1, v2 + v2 - s2]", "[s1 + d1, v2 + v2 - s2]"),
    mutant("H50, second order: trapezoid, outer state", FILTER, "[s1 + d1 + d1, v2 + v2 - s2]", "[s1 + d1 + d1, v2]"),
    mutant("H50: pre-warping", FILTER, "libm::tan(PI * ratio)", "PI * ratio"),
    mutant("position control: error", PD, "error.times(self.kp) - state", "-state"),
    mutant("position control: velocity", PD, " - state.velocity.times(self.kd)", ""),
    mutant("position control: smoothing of the velocity", PD, "state.velocity + (moved - state.velocity).times(self.smooth)", "moved"),
    mutant("position control: limit of the velocity", PD, "velocity.clamp(-R::ONE, R::ONE)", "velocity"),
    mutant("position control: limits of the setpoint", PD, "setpoint.clamp(self.min, self.max)", "setpoint"),
    mutant("position control: limit of the duty", PD, "wanted.clamp(-self.limit, self.limit)", "wanted"),
    mutant("position control: limit of the slew", PD, "(wanted - state.output).clamp(-self.slew, self.slew)", "(wanted - state.output)"),
    mutant("table of tanh, fixed point: segment 7, coefficient 0, bit 20", FIXED, "static HALF_TANH: Cubics<24> = cubics!(half_tanh, 24 segments of 1.0 / 16.0, from 0.0);", "static HALF_TANH: Cubics<24> = { let mut t = cubics!(half_tanh, 24 segments of 1.0 / 16.0, from 0.0); t.0[7][0] ^= 1 << 20; t };"),
    mutant("table of tanh, fixed point: segment 11, coefficient 2, bit 4", FIXED, "static HALF_TANH: Cubics<24> = cubics!(half_tanh, 24 segments of 1.0 / 16.0, from 0.0);", "static HALF_TANH: Cubics<24> = { let mut t = cubics!(half_tanh, 24 segments of 1.0 / 16.0, from 0.0); t.0[11][2] ^= 1 << 4; t };"),
    mutant("table of exp, fixed point: segment 7, coefficient 0, bit 20", FIXED, "static EXP_NEG: Cubics<18> = cubics!(exp_neg, 18 segments of 1.0 / 8.0, from 0.0);", "static EXP_NEG: Cubics<18> = { let mut t = cubics!(exp_neg, 18 segments of 1.0 / 8.0, from 0.0); t.0[7][0] ^= 1 << 20; t };"),
    mutant("table of exp, fixed point: segment 11, coefficient 2, bit 4", FIXED, "static EXP_NEG: Cubics<18> = cubics!(exp_neg, 18 segments of 1.0 / 8.0, from 0.0);", "static EXP_NEG: Cubics<18> = { let mut t = cubics!(exp_neg, 18 segments of 1.0 / 8.0, from 0.0); t.0[11][2] ^= 1 << 4; t };"),
    mutant("table of 1/√x, fixed point: segment 7, coefficient 0, bit 20", FIXED, "static INV_SQRT: Cubics<24> = cubics!(inv_sqrt_halved, 24 segments of 1.0 / 32.0, from 0.25);", "static INV_SQRT: Cubics<24> = { let mut t = cubics!(inv_sqrt_halved, 24 segments of 1.0 / 32.0, from 0.25); t.0[7][0] ^= 1 << 20; t };"),
    mutant("table of 1/√x, fixed point: segment 11, coefficient 2, bit 4", FIXED, "static INV_SQRT: Cubics<24> = cubics!(inv_sqrt_halved, 24 segments of 1.0 / 32.0, from 0.25);", "static INV_SQRT: Cubics<24> = { let mut t = cubics!(inv_sqrt_halved, 24 segments of 1.0 / 32.0, from 0.25); t.0[11][2] ^= 1 << 4; t };"),
    mutant("table of quantiles: entry 12, bit 12", NOISE, "    table\n}\n\n/// A standard normal number", "    table[12] ^= 1 << 12;\n    table\n}\n\n/// A standard normal number"),
    mutant("table of quantiles: entry 5, bit 2", NOISE, "    table\n}\n\n/// A standard normal number", "    table[5] ^= 1 << 2;\n    table\n}\n\n/// A standard normal number"),
    mutant("coefficients of tanh, f32: last bit of p₁", SINGLE, "0.477_403_25", "0.477_403_28"),
    mutant("coefficients of tanh, f32: last bit of q₂", SINGLE, "0.005_177_928]", "0.005_177_928_5]"),
    mutant("coefficients of exp, f32: last bit of c₃", SINGLE, "-0.054_110_028", "-0.054_110_03"),
    mutant("coefficients of exp, f32: last bit of c₇", SINGLE, "-6.730_117e-5", "-6.730_118e-5"),
    mutant("guess of 1/√x, f32: last bit", SINGLE, "0x5F37_5A86", "0x5F37_5A87"),
];
