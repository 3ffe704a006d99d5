/** The page's icons: 16 px line drawings on one grid. */

const PATHS = {
  down: "M4.5 6.5L8 10l3.5-3.5",
  left: "M9.5 4.5L6 8l3.5 3.5",
  right: "M6.5 4.5L10 8l-3.5 3.5",
  check: "M3 8.5l3.2 3.2L13 4.5",
  warning: "M8 2L15 13.5H1zM8 6.5v3.5M8 11.8v.4",
  offline:
    "M2 2l12 12M4 7a6 6 0 0 1 2-1.3M9 5.3a6 6 0 0 1 3 1.7M6.3 9.6a2.5 2.5 0 0 1 3 0M8 12.5v.1",
  play: "M4.5 2.5l9 5.5-9 5.5z",
  pause: "M5 3v10M11 3v10",
  start: "M12 3L6 8l6 5zM4 3v10",
  end: "M4 3l6 5-6 5zM12 3v10",
  close: "M4 4l8 8M12 4l-8 8",
  download: "M8 2v8M4.5 7L8 10.5L11.5 7M2.5 13.5h11",
  link: "M6.5 9.5l3-3M7 4.5l1.5-1.5a3 3 0 0 1 4.3 4.3L11.3 9M9 11.5L7.5 13a3 3 0 0 1-4.3-4.3L4.7 7",
  moon: "M13 9.5A5.5 5.5 0 1 1 6.5 3a4.5 4.5 0 0 0 6.5 6.5z",
  sun: "M8 5a3 3 0 1 0 0 6a3 3 0 0 0 0-6zM8 1v1.5M8 13.5V15M1 8h1.500M13.500 8H15M3 3l1.100 1.100M11.900 11.900L13 13M13 3l-1.100 1.100M4.100 11.900L3 13",
  select: "M3 2l10 5-4.2 1.6L7 13z",
  stair: "M1.5 13.5h4v-4h4v-4h5",
  ramp: "M1.5 13h13M1.5 13L14.5 4",
  flat: "M1.5 9h13M1.5 6v6M14.5 6v6",
  free: "M1.5 13c2-8 4-2 6-5s2-6 7-5",
  plus: "M8 3v10M3 8h10",
  trash: "M2.5 4.5h11M6 4.5V2.5h4v2M4 4.5l.7 9h6.6l.7-9",
  undo: "M6 3L2.5 6.5L6 10M2.5 6.5H10a3.5 3.5 0 0 1 0 7H7",
  redo: "M10 3l3.5 3.5L10 10M13.5 6.5H6a3.5 3.5 0 0 0 0 7h3",
  snap: "M4 2v6a4 4 0 0 0 8 0V2M2.5 5h3M10.5 5h3",
  eye: "M1.5 8s2.5-4.5 6.5-4.5S14.5 8 14.5 8s-2.5 4.5-6.5 4.5S1.5 8 1.5 8zM8 6.2a1.8 1.8 0 1 0 0 3.6a1.8 1.8 0 0 0 0-3.6z",
  fit: "M2.5 6v-3.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  camera: "M2 4.5h8v7H2zM10 7l4-2v6l-4-2",
  record: "M8 2.5a5.5 5.5 0 1 0 0 11a5.5 5.5 0 0 0 0-11zM8 6a2 2 0 1 0 0 4a2 2 0 0 0 0-4z",
  reset: "M3 8a5 5 0 1 0 1.8-3.8M3 2.5V5.5h3",
  open: "M6 3H3v10h10v-3M9 2.5h4.5V7M13.5 2.5L7.5 8.5",
  exchange: "M3 5.5h9M9.5 3L12 5.5L9.5 8M13 10.5H4M6.500 8L4 10.5L6.500 13",
  swap: "M10.5 2.500l3 3l-3 3M13.500 5.500h-10.500M5.500 7.500l-3 3l3 3M2.500 10.500h10.500",
  table: "M2.5 3.500h11v9h-11zM2.5 6.500h11M7 3.500v9",
  chart: "M2.500 2.500v11h11M5 10l2.500-3 2 1.500L13 4.500",
  upload: "M8 10.500v-8M4.5 5.500L8 2L11.5 5.500M2.5 13.5h11",
  more: "M3 8h.1M8 8h.1M13 8h.1",
  maximise: "M9.5 2.5h4v4M6.5 13.5h-4v-4M13.5 2.5l-4.5 4.5M2.5 13.5l4.5-4.5",
  restore: "M13.5 6.500h-4v-4M2.5 9.500h4v4M9.500 6.500l4-4M6.500 9.500l-4 4",
  list: "M6 4h7.500M6 8h7.500M6 12h7.500M2.500 4h.500M2.500 8h.500M2.500 12h.500",
  copy: "M5.500 5.500h8v8h-8zM3.500 10.500h-1v-8h8v1",
  save: "M3 2.500h8l2.500 2.500v8.500h-10.500zM5.500 2.500v3.500h4.500v-3.500M5.500 13.500v-4h5v4",
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name, fill, turn }: { name: IconName; fill?: boolean; turn?: boolean }) {
  return (
    <svg
      class={`i${fill ? " fill" : ""}${turn ? " turn" : ""}`}
      viewBox="0 0 16 16"
      aria-hidden="true"
    >
      <path d={PATHS[name]} />
    </svg>
  );
}

export function Logo() {
  return (
    <svg viewBox="0 0 22 22" aria-hidden="true" class="logo">
      <path
        d="M1.5 19.5h6v-5h6v-5h7"
        fill="none"
        stroke="currentColor"
        stroke-width="2.2"
        stroke-linejoin="round"
        stroke-linecap="round"
      />
      <circle cx="9.8" cy="7" r="3.6" fill="none" stroke="var(--ac)" stroke-width="2.2" />
    </svg>
  );
}
