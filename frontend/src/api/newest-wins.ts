/**
 * At most one request in flight. While it runs only the newest question is kept; when the answer
 * comes back that question is sent. Answers older than the one already shown are dropped.
 */
export class NewestWins<Question, Answer> {
  private waiting: { question: Question; sequence: number } | null = null;
  private running = false;
  private asked = 0;
  private shown = 0;

  constructor(
    private readonly solve: (question: Question) => Promise<Answer>,
    private readonly show: (answer: Answer, question: Question, newest: boolean) => void,
    private readonly fail: (error: unknown, newest: boolean) => void,
  ) {}

  get busy(): boolean {
    return this.running;
  }

  ask(question: Question): void {
    this.waiting = { question, sequence: ++this.asked };
    if (!this.running) void this.pump();
  }

  /** Forget what was asked: an answer still on its way will not be shown. */
  forget(): void {
    this.waiting = null;
    this.shown = this.asked;
  }

  private async pump(): Promise<void> {
    this.running = true;
    while (this.waiting) {
      const { question, sequence } = this.waiting;
      this.waiting = null;
      try {
        const answer = await this.solve(question);
        if (sequence > this.shown) {
          this.shown = sequence;
          this.show(answer, question, sequence === this.asked);
        }
      } catch (error) {
        this.fail(error, sequence === this.asked);
      }
    }
    this.running = false;
  }
}
