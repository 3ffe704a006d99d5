/** Types of the service's documents, from its OpenAPI document: `npm run types`. */

import { writeFileSync } from "node:fs";
import openapiTS, { astToString } from "openapi-typescript";

const [source, target] = process.argv.slice(2);
const document = await (await fetch(source)).text();
// Titles only repeat names; routes are asked by hand, in client.ts.
const plain = JSON.parse(document, (key, value) =>
  key === "title" && typeof value === "string" ? undefined : value,
);
writeFileSync(
  target,
  astToString(await openapiTS({ ...plain, info: { title: "", version: "" }, paths: {} })),
);
