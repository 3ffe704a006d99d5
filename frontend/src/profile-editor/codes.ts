/** Stairs as building codes and makers have them [m]. */

export interface Stair {
  rise: number;
  run: number;
}

export interface StairCode extends Stair {
  name: string;
  note: string;
}

export const CODES: readonly StairCode[] = [
  { name: "US building 7 / 11 in", note: "0.178 / 0.279", rise: 0.178, run: 0.279 },
  { name: "US home 7¾ / 10 in", note: "0.197 / 0.254", rise: 0.197, run: 0.254 },
  { name: "Public 0.18 / 0.28", note: "0.180 / 0.280", rise: 0.18, run: 0.28 },
  { name: "DIN 18065 17 / 29", note: "0.170 / 0.290", rise: 0.17, run: 0.29 },
  { name: "Industrial", note: "0.200 / 0.250", rise: 0.2, run: 0.25 },
  { name: "The paper's", note: "0.125 / 0.300", rise: 0.125, run: 0.3 },
];
