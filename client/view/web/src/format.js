// Numbers as people read them; the same rules as client/report/numbers.h.

export function length(mm) {
  if (mm < 9999.95) return `${mm.toFixed(1)} mm`;
  const m = mm / 1000;
  if (m < 99.995) return `${m.toFixed(2)} m`;
  if (m < 9999.95) return `${m.toFixed(1)} m`;
  return `${(m / 1000).toFixed(2)} km`;
}

export function duration(seconds) {
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  const s = Math.round(seconds);
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${s % 60} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 24 * 60) return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
  const hours = Math.round(seconds / 3600);
  return `${Math.floor(hours / 24)} d ${hours % 24} h`;
}

export function gain(before, after) {
  if (before === after) return 0;
  return before > 0 ? (100 * (before - after)) / before : -100;
}

// "−42.5 %", with a real minus sign.
export function change(before, after) {
  const percent = -gain(before, after);
  if (Math.abs(percent) < 0.05) return "±0 %";
  return `${percent < 0 ? "−" : "+"}${Math.abs(percent).toFixed(1)} %`;
}

export const percent = (share) => `${(100 * share).toFixed(1)} %`;
export const crossings = (n) => `${n} ${n === 1 ? "wall" : "walls"} crossed`;
export const retractions = (n) => `${n} ${n === 1 ? "retraction" : "retractions"}`;
