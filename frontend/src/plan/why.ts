/** Why there is no plan, in a sentence; until that is found out, that it is looked for. */

import type { Plan } from "../api/types";
import { reason } from "../geometry/format";
import { preview } from "../state/planning";

const LOOKING = "No path. Finding out what would open one …";

export const why = (shown: Plan): string =>
  shown === preview.value ? LOOKING : reason(shown.problem?.message ?? "");
