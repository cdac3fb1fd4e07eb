// The hair's vibration as sound, on request: what the sensor at its root reads, without the slow
// swing.

const RATE_HZ = 8000;
// The whisk is at 2 Hz, what surfaces make of it above; at another speed both are elsewhere.
const LOW_CUT_HZ = 60;
const AHEAD_S = 0.08;
const sound = { context: null, cut: null, until: 0, last: 0 };

export const sounds = () => sound.context !== null;

/** Starts, which a browser allows after a press only, or stops. */
export function listen(on) {
  if (!on) {
    sound.context?.close();
    sound.context = null;
    return;
  }
  sound.context = new AudioContext();
  const cut = new BiquadFilterNode(sound.context, { type: "highpass", frequency: LOW_CUT_HZ });
  const loud = new GainNode(sound.context, { gain: 6 });
  const limit = new DynamicsCompressorNode(sound.context);
  cut.connect(loud).connect(limit).connect(sound.context.destination);
  [sound.cut, sound.until, sound.last] = [cut, 0, null];
}

/** Plays codes, `hz` of them a second, after those before, at so many times real time. */
export function hear(codes, hz, speed) {
  const { context } = sound;
  if (context?.state !== "running" || codes.length === 0) return;
  sound.cut.frequency.value = LOW_CUT_HZ * speed;
  const values = Array.from(codes, (code) => (code - 8192) / 8192);
  const before = sound.last ?? values[0];
  sound.last = values.at(-1);
  const count = Math.round(values.length * RATE_HZ / hz);
  const buffer = new AudioBuffer({ length: Math.max(count, 1), sampleRate: RATE_HZ });
  const wave = buffer.getChannelData(0);
  for (let n = 0; n < count; n++) {
    // On the straight line between two readings.
    const at = (n + 1) * values.length / count - 1;
    const k = Math.floor(at);
    const from = k < 0 ? before : values[k];
    wave[n] = from + (at - k) * (values[Math.min(k + 1, values.length - 1)] - from);
  }
  const source = new AudioBufferSourceNode(context, { buffer });
  source.connect(sound.cut);
  const late = sound.until < context.currentTime || sound.until > context.currentTime + 0.5;
  if (late) sound.until = context.currentTime + AHEAD_S;
  source.start(sound.until);
  sound.until += buffer.duration;
}
