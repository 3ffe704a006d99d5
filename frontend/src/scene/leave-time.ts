/**
 * The scene leaves the page its share of the thread that both run on. Without a graphics card a
 * frame of the scene takes longer than a hand waits, and after each change viser draws several.
 */

/**
 * While `busy`, what the frame asks to be drawn waits for as long as its last frame took, so that
 * half of the time is the page's. Where frames are quick, nothing waits.
 */
export function leaveTime(frame: Window, busy: () => boolean): void {
  const own = frame.requestAnimationFrame.bind(frame);
  const drop = frame.cancelAnimationFrame.bind(frame);
  /** When the frame that is being drawn began; null between frames. */
  let begun: number | null = null;
  let free = 0;
  // A message comes after the frame has been handed on to be shown, which is most of the work.
  const { port1: after, port2: tell } = new MessageChannel();
  after.onmessage = () => {
    const end = performance.now();
    free = end + (end - (begun ?? end));
    begun = null;
  };
  /** Requests that wait: the id that was given out, and the one that stands for it now. */
  const waiting = new Map<number, number>();
  frame.requestAnimationFrame = (callback) => {
    const id = own(function draw(time) {
      const now = performance.now();
      if (busy() && now < free) {
        waiting.set(id, own(draw));
        return;
      }
      waiting.delete(id);
      if (begun === null) {
        begun = now;
        tell.postMessage(null);
      }
      callback(time);
    });
    return id;
  };
  frame.cancelAnimationFrame = (id) => {
    drop(waiting.get(id) ?? id);
    waiting.delete(id);
  };
}
