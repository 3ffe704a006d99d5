/** Numbers as they stand on screen: a true minus sign, fixed digits. */

export function fixed(value: number, digits: number): string {
  if (!Number.isFinite(value)) return "–";
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** A number that may not be known. */
export const maybe = (value: number | null | undefined, digits: number, unit = "") =>
  value === null || value === undefined ? "–" : fixed(value, digits) + unit;

export const degrees = (radians: number) => (radians * 180) / Math.PI;

export const millimetres = (metres: number) => `${fixed(metres * 1000, 0)} mm`;

/** A duration of a computation: 0.9 ms, 14 ms, 1.3 s. */
export function took(seconds: number): string {
  if (seconds >= 1) return `${fixed(seconds, 1)} s`;
  const ms = seconds * 1000;
  return `${fixed(ms, ms < 10 ? 1 : 0)} ms`;
}

export const capital = (words: string) => words.charAt(0).toUpperCase() + words.slice(1);

/** A reason of the service as it stands on screen: true minus signs, degrees, whole equations. */
export const reason = (words: string) =>
  capital(words)
    .replace(/(?<![\w-])-(?=\d)/g, "−")
    .replace(
      /(\d+(?:\.\d+)?) rad\b(?!\/)/g,
      (_, radians: string) => `${fixed(degrees(Number(radians)), 1)}°`,
    )
    // No line ends between a number, what it is equal to, and its unit.
    .replace(/ = | (?=(?:m|Nm)\b)/g, (space) => space.replaceAll(" ", "\u00a0"));

/** Remaining time, no finer than it is known: about 5 s, about 2 min. */
export function about(seconds: number): string {
  if (seconds < 60) return `about ${Math.max(1, Math.ceil(seconds / 5) * 5)} s`;
  if (seconds < 3600) return `about ${Math.ceil(seconds / 60)} min`;
  return `about ${fixed(seconds / 3600, 1)} h`;
}

/** A setting: as short as it can be without losing what the slider can set. */
export function setting(value: number): string {
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size < 0.01 || size >= 100_000) {
    return value
      .toExponential(size === 10 ** Math.round(Math.log10(size)) ? 0 : 1)
      .replace("-", "−");
  }
  if (size < 0.1) return fixed(value, 3);
  if (size < 10) return fixed(value, 2);
  return fixed(value, size < 100 ? 1 : 0);
}

/** The slope between two points as builders say it. */
export function slope(dx: number, dz: number): string {
  const angle = degrees(Math.atan2(dz, dx));
  const ratio = Math.abs(dx / dz);
  return `${fixed(angle, 1)}° · 1:${ratio < 10 ? fixed(ratio, 1) : fixed(ratio, 0)}`;
}
