/** A number that can be typed, stepped with the arrows, and left unfinished while typing. */

import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

interface NumberFieldProps {
  value: number;
  label: string;
  format: (value: number) => string;
  min?: number;
  max?: number;
  step?: number;
  class?: string;
  disabled?: boolean;
  /** Each valid value as it is typed or stepped. */
  onChange: (value: number) => void;
  /** The edit is finished: Enter, or the focus left. */
  onDone?: () => void;
  onCancel?: () => void;
  /** What is wrong with what was typed; empty where nothing is. */
  onComplaint?: (complaint: string) => void;
  focus?: boolean;
}

/** Accepts a decimal comma and a true minus sign. */
export function parseNumber(text: string): number {
  const plain = text.trim().replace(",", ".").replace("−", "-");
  return plain === "" ? Number.NaN : Number(plain);
}

export function NumberField(props: NumberFieldProps) {
  const { value, label, format, min = -Infinity, max = Infinity, step } = props;
  const [text, setText] = useState<string | null>(null);
  const input = useRef<HTMLInputElement>(null);
  const shown = text ?? format(value);
  const parsed = text === null ? value : parseNumber(text);
  const valid = text === null || (Number.isFinite(parsed) && parsed >= min && parsed <= max);
  const complaint = Number.isFinite(parsed)
    ? `Between ${format(min)} and ${format(max)}`
    : `Not a number: ${format(value)} stays`;
  const wrong = valid ? "" : complaint;

  useEffect(() => props.onComplaint?.(wrong), [wrong]);

  useEffect(() => {
    // A value that was set elsewhere is newer than text that was left behind.
    if (document.activeElement !== input.current) setText(null);
  }, [value]);

  useLayoutEffect(() => {
    if (!props.focus) return;
    input.current?.focus();
    input.current?.select();
  }, [props.focus]);

  const type = (next: string) => {
    setText(next);
    const number = parseNumber(next);
    if (Number.isFinite(number) && number >= min && number <= max) props.onChange(number);
  };
  const finish = () => {
    // What cannot be read stays, to be seen and mended; nothing at all is no entry.
    if (valid || shown.trim() === "") setText(null);
    props.onDone?.();
  };
  const onKeyDown = (event: KeyboardEvent) => {
    event.stopPropagation();
    if (event.key === "Enter" && valid) finish();
    else if (event.key === "Escape") {
      setText(null);
      props.onCancel?.();
      input.current?.blur();
    } else if (step && (event.key === "ArrowUp" || event.key === "ArrowDown")) {
      event.preventDefault();
      const by = (event.key === "ArrowUp" ? 1 : -1) * step * (event.shiftKey ? 10 : 1);
      const from = Number.isFinite(parsed) ? parsed : Number.isFinite(value) ? value : min;
      const next = Math.min(max, Math.max(min, from + by));
      setText(null);
      props.onChange(Number(next.toPrecision(12)));
    }
  };

  return (
    <input
      ref={input}
      type="text"
      inputMode="decimal"
      class={`num ${props.class ?? ""}`}
      aria-label={label}
      aria-invalid={!valid}
      title={wrong || undefined}
      disabled={props.disabled}
      value={shown}
      autocomplete="off"
      spellcheck={false}
      onFocus={(event) => event.currentTarget.select()}
      onInput={(event) => type(event.currentTarget.value)}
      onKeyDown={onKeyDown}
      onBlur={finish}
    />
  );
}
