/** Studies over REST: what the service says of them, and the events of one that is at work. */

import { BASE, callJson } from "../api/client";
import type { components } from "../api/schema";

type Schemas = components["schemas"];

export type StudyState = Schemas["StudyDocument"];
export type StudyAxis = Schemas["AxisDocument"];
export type CellAnswer = Schemas["CellDocument"];

/** Cells: one list a variable; `cell` numbers them. Null where there is no number. */
export interface Block {
  cell: number[];
  state: number[];
  feasible: boolean[];
  reason: string[];
  message: string[];
  quantity: string[];
  binding: string[];
  [variable: string]: (number | string | boolean | null)[];
}

/** A study to ask: `stairwright/study/1`. */
export type StudyDocument = Record<string, unknown>;

const path = (id: string) => `studies/${encodeURIComponent(id)}`;

export const postStudy = (document: StudyDocument) =>
  callJson<StudyState>("POST", "studies", document);
export const listStudies = () => callJson<StudyState[]>("GET", "studies?limit=30");
export const getStudy = (id: string) => callJson<StudyState>("GET", path(id));
export const getStudyDocument = (id: string) =>
  callJson<StudyDocument>("GET", `${path(id)}/document`);
export const cancelStudy = (id: string) => callJson<StudyState>("POST", `${path(id)}/cancel`);
export const getCell = (id: string, cell: number) =>
  callJson<CellAnswer>("GET", `${path(id)}/cells/${cell}`);
export const studyExport = (id: string, format: string) =>
  `${BASE}/${path(id)}/export?format=${format}`;

interface Hearing {
  cells: (block: Block) => void;
  /** Without the axes. */
  state: (state: Omit<StudyState, "axes">) => void;
}

/** Follow a study until it is finished; the answer ends that. The browser connects again itself. */
export function followStudy(id: string, hear: Hearing): () => void {
  const source = new EventSource(`${BASE}/${path(id)}/events`);
  source.addEventListener("cells", (event) => hear.cells(JSON.parse(event.data) as Block));
  source.addEventListener("study", (event) => {
    const state = JSON.parse(event.data) as StudyState;
    if (!["queued", "running"].includes(state.state)) source.close();
    hear.state(state);
  });
  return () => source.close();
}
