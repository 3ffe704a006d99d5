import { useLayoutEffect, useRef } from "preact/hooks";

/** For an element whose size is to be known: `take` is called as it is laid out. */
export function useMeasured(take: (element: HTMLDivElement) => void) {
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const element = box.current!;
    const observer = new ResizeObserver(() => take(element));
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  return box;
}
