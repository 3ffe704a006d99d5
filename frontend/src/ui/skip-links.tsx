/** First stops of the Tab key: past the bars, to what one came for. */

const TARGETS: [string, string][] = [
  ["Skip to the profile", "[data-vertex]"],
  ["Skip to the timeline", ".scrub"],
  ["Skip to the settings", ".insp [role=slider]"],
];

function jump(selector: string): void {
  const visible = [...document.querySelectorAll<HTMLElement | SVGElement>(selector)].find(
    (each) => each.getClientRects().length > 0,
  );
  visible?.focus();
}

export function SkipLinks() {
  return (
    <nav class="skips" aria-label="Skip">
      {TARGETS.map(([title, selector]) => (
        <button key={title} type="button" onClick={() => jump(selector)}>
          {title}
        </button>
      ))}
    </nav>
  );
}
