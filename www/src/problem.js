/** Something a person did that cannot work: what is wrong, and what to do about it. */
export class Problem extends Error {
  constructor(message, remedy = '') {
    super(message);
    this.remedy = remedy;
  }
}

/** Any error as a problem to show. */
export function asProblem(error, what) {
  if (error instanceof Problem) return error;
  const message = error instanceof Error ? error.message : String(error);
  return new Problem(what, message);
}
