/** One of a few choices side by side; arrows walk them. */

import type { Signal } from "@preact/signals";

interface SegmentsProps<T extends string> {
  label: string;
  /** In a header: no visible label. */
  small?: boolean;
  options: [T, string][];
  value: T;
  onChoose: (value: T) => void;
}

export function Segments<T extends string>({
  label,
  small,
  options,
  value,
  onChoose,
}: SegmentsProps<T>) {
  const onKeyDown = (event: KeyboardEvent) => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    const at = options.findIndex(([each]) => each === value);
    const next = (at + by + options.length) % options.length;
    onChoose(options[next]![0]);
    (event.currentTarget as HTMLElement)
      .querySelectorAll<HTMLElement>("[role=radio]")
      [next]?.focus();
  };
  return (
    <div class={small ? "r2 small" : "r2"}>
      {!small && <span class="lab">{label}</span>}
      <div class="seg" role="radiogroup" aria-label={label} tabIndex={-1} onKeyDown={onKeyDown}>
        {options.map(([each, text]) => (
          <button
            key={each}
            type="button"
            role="radio"
            tabIndex={each === value ? 0 : -1}
            aria-checked={each === value}
            class={each === value ? "on" : ""}
            onClick={() => onChoose(each)}
          >
            {text}
          </button>
        ))}
      </div>
    </div>
  );
}

/** The same of a choice that a signal holds. */
export function Choice<T extends string>({
  of,
  ...named
}: Omit<SegmentsProps<T>, "value" | "onChoose"> & { of: Signal<T> }) {
  return (
    <Segments
      {...named}
      value={of.value}
      onChoose={(next) => {
        of.value = next;
      }}
    />
  );
}
