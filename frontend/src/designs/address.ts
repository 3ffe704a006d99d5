/** Design searches in the address of the page, so that a link shows them. */

import { effect, untracked } from "@preact/signals";
import { decode, encode, given, kept } from "../state/share";
import { form } from "./form";
import { across, openSearch, search, showsDesigns, trouble } from "./state";

/** What the address keeps: the form, the shown search and the aims on its axes. */
interface Kept {
  f: typeof form.value;
  i?: string;
  a: readonly [number, number];
}

/** A link shows what it names: cells or designs. */
export const followLinks = () =>
  effect(() => {
    if (given.value.has("d")) showsDesigns.value = true;
    else if (given.value.has("m")) showsDesigns.value = false;
  });

let begun = false;

/** The first time that the room is open: what the address names, and from now on keep it there. */
export function begin(): void {
  if (begun) return;
  begun = true;
  effect(() => {
    const text = given.value.get("d");
    if (text && text !== kept.peek().d) untracked(() => restore(text));
  });
  effect(() => {
    const { d: _, ...others } = kept.peek();
    const state: Kept = { f: form.value, a: across.value };
    if (search.value) state.i = search.value.id;
    kept.value = showsDesigns.value ? { ...others, d: encode(state) } : others;
  });
}

function restore(text: string): void {
  try {
    const { f, i, a } = decode(text) as Kept;
    if (!Array.isArray(f.aims) || !a.every(Number.isInteger)) throw new TypeError();
    form.value = { ...form.peek(), ...f };
    if (i) {
      void openSearch(i).then(() => {
        if (search.peek()?.id === i) across.value = a;
      });
    }
  } catch {
    trouble.value = "The search in this link could not be read.";
  }
}
