/** Pinned results over each other. */

export function Overlay({ back }: { back: () => void }) {
  return (
    <button type="button" class="t back" onClick={back}>
      List
    </button>
  );
}
