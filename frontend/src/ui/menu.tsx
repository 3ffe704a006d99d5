/** A button with a panel below it: arrows walk its items, Escape closes and gives the focus back. */

import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";

interface MenuProps {
  /** Names panel and button; with `named` the button's own text is its name. */
  label: string;
  named?: boolean;
  button: ComponentChildren;
  buttonClass: string;
  panelClass?: string;
  /** A dialog holds fields; a menu holds only items. */
  kind?: "menu" | "dialog";
  align?: "left" | "right";
  disabled?: boolean;
  children: (close: () => void) => ComponentChildren;
}

const ITEMS = "[role^=menuitem]:not([disabled])";

export function Menu(props: MenuProps) {
  const { label, button, buttonClass, panelClass, kind = "menu", align = "left", disabled } = props;
  const [isOpen, setOpen] = useState(false);
  const root = useRef<HTMLDivElement>(null);
  const trigger = useRef<HTMLButtonElement>(null);

  const close = () => {
    setOpen(false);
    trigger.current?.focus();
  };

  // Before anybody can type: a focus that came later would take the field from under the hand.
  useLayoutEffect(() => {
    if (!isOpen) return;
    const first = root.current?.querySelector<HTMLElement>(
      kind === "menu" ? ITEMS : "input, select, textarea, .panel button",
    );
    first?.focus();
    const outside = (event: PointerEvent) => {
      if (!root.current?.contains(event.target as Node)) setOpen(false);
    };
    addEventListener("pointerdown", outside, true);
    const intoFrame = () => document.activeElement?.tagName === "IFRAME" && setOpen(false);
    addEventListener("blur", intoFrame);
    // An item that is deleted takes the focus along; the panel still closes by key.
    const orphaned = (event: KeyboardEvent) => {
      if (event.key !== "Escape" || document.activeElement !== document.body) return;
      setOpen(false);
      trigger.current?.focus();
    };
    addEventListener("keydown", orphaned);
    return () => {
      removeEventListener("keydown", orphaned);
      removeEventListener("pointerdown", outside, true);
      removeEventListener("blur", intoFrame);
    };
  }, [isOpen, kind]);

  const onKeyDown = (event: KeyboardEvent) => {
    if (!isOpen) return;
    event.stopPropagation();
    if (event.key === "Escape") close();
    if (event.key === "Tab" && kind === "menu") setOpen(false);
    if (kind !== "menu" || !/^(Arrow(Up|Down)|Home|End)$/.test(event.key)) return;
    event.preventDefault();
    const items = [...(root.current?.querySelectorAll<HTMLElement>(ITEMS) ?? [])];
    const at = items.indexOf(document.activeElement as HTMLElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key] ?? 0;
    items.at(to >= items.length ? 0 : to)?.focus();
  };

  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: only catches keys that bubble from the items
    <div class="menu-root" ref={root} onKeyDown={onKeyDown}>
      <button
        type="button"
        ref={trigger}
        class={buttonClass}
        disabled={disabled}
        aria-haspopup={kind}
        aria-expanded={isOpen}
        aria-label={props.named ? undefined : label}
        title={label}
        onClick={() => setOpen(!isOpen)}
      >
        {button}
      </button>
      {isOpen && (
        // biome-ignore lint/a11y/useAriaPropsSupportedByRole: the role is a menu or a dialog
        <div class={`panel ${align} ${panelClass ?? ""}`} role={kind} aria-label={label}>
          {props.children(close)}
        </div>
      )}
    </div>
  );
}

interface ItemProps {
  onChoose: () => void;
  checked?: boolean;
  disabled?: boolean;
  children: ComponentChildren;
}

export function MenuItem({ onChoose, checked, disabled, children }: ItemProps) {
  return (
    // biome-ignore lint/a11y/useAriaPropsSupportedByRole: checked comes with the radio role
    <button
      type="button"
      role={checked === undefined ? "menuitem" : "menuitemradio"}
      aria-checked={checked}
      class="item"
      tabIndex={-1}
      disabled={disabled}
      onClick={onChoose}
    >
      {children}
    </button>
  );
}
