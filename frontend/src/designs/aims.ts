/** What a search may aim at: a number that varies, the mass, a result, or the border of a quantity. */

import { QUANTITIES } from "../map/quantities";
import type { Aim } from "./state";

export interface AimChoice {
  /** Names it in the form. */
  key: string;
  title: string;
  aim: Aim;
  /** Of a border: between which values it is searched for, and how finely. */
  border?: { unit: string; digits: number; from: number; to: number; tolerance: number };
}

const less = (name: string, title: string): AimChoice => ({
  key: `less ${name}`,
  title: `Less ${title}`,
  aim: { minimise: name } as Aim,
});

const more = (name: string, title: string): AimChoice => ({
  key: `more ${name}`,
  title: `More ${title}`,
  aim: { maximise: name } as Aim,
});

const LENGTH = { unit: "m", digits: 2, tolerance: 0.02 };

/** Of these the search finds the last value that a design passes. */
const BORDERS: readonly AimChoice[] = [
  { ...more("step.height", "step height"), border: { ...LENGTH, from: 0.1, to: 1 } },
  { ...more("stairs.rise", "rise of stairs"), border: { ...LENGTH, from: 0.1, to: 0.5 } },
  {
    ...more("payload", "payload"),
    border: { unit: "kg", digits: 1, from: 0, to: 20, tolerance: 0.5 },
  },
  {
    ...less("friction", "friction"),
    border: { unit: "", digits: 2, from: 0.1, to: 0.8, tolerance: 0.05 },
  },
];

const title = (name: string) => QUANTITIES.find((each) => each.name === name)!.title;
export const lowerFirst = (text: string) => text.charAt(0).toLowerCase() + text.slice(1);

const PLANNED: readonly AimChoice[] = [
  more("margin_com", title("margin_com")),
  more("margin_torque", lowerFirst(title("margin_torque"))),
  more("margin_clearance", lowerFirst(title("margin_clearance"))),
  less("duration", lowerFirst(title("duration"))),
];

/** Only a simulated climb has these. */
const SIMULATED: readonly AimChoice[] = [
  less("energy", "energy"),
  less("cost_of_transport", "cost of transport"),
];

/** What can be aimed at while `varied` numbers vary, the most usual first. */
export function aimChoices(
  varied: readonly { name: string; title: string }[],
  simulated: boolean,
): AimChoice[] {
  return [
    ...varied.map((each) => less(each.name, lowerFirst(each.title))),
    less("mass", "mass"),
    ...PLANNED,
    ...(simulated ? SIMULATED : []),
    ...BORDERS,
  ];
}
