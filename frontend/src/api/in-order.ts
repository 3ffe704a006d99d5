/** Reading again while an earlier answer is still under way: one older than what is shown is dropped. */
export function inOrder<Answer>(
  ask: () => Promise<Answer>,
  show: (answer: Answer) => void,
): () => Promise<void> {
  let asked = 0;
  let shown = 0;
  return async () => {
    const sequence = ++asked;
    const answer = await ask();
    if (sequence < shown) return;
    shown = sequence;
    show(answer);
  };
}
