// Between a slider's place (0..1) and a value. Wide ranges from zero get finer steps near zero.
// Pure functions.

const WIDE = 200; // steps
const FINE = 3; // exponent

interface Range {
  min: number;
  max: number;
  step: number;
}

function exponent({ min, max, step }: Range): number {
  return min >= 0 && step > 0 && (max - min) / step > WIDE ? FINE : 1;
}

export function value_at(place: number, range: Range): number {
  const value = range.min + (range.max - range.min) * place ** exponent(range);
  return limited(range.step > 0 ? Math.round(value / range.step) * range.step : value, range);
}

export function place_of(value: number, range: Range): number {
  const share = (limited(value, range) - range.min) / (range.max - range.min || 1);
  return share ** (1 / exponent(range));
}

export function limited(value: number, { min, max }: Range): number {
  return Math.min(max, Math.max(min, value));
}

// Few digits, no trailing zeros.
export function number_text(value: number): string {
  return String(Number(value.toPrecision(4)));
}
