/** What is wrong with a file, in one sentence of the service's. */

import { ApiError, reasonOf } from "../api/client";

/** Points say in their message which one they are; any other field is named. */
const NAMED_BY_MESSAGE = /^(file|points(\.\d+)?)$/;

export function wrongWith(error: unknown): string {
  const first = error instanceof ApiError ? error.problem.errors?.[0] : undefined;
  if (!first) return reasonOf(error);
  return NAMED_BY_MESSAGE.test(first.field) ? first.message : `${first.field}: ${first.message}`;
}
