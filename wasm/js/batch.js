/** One that is refused holds up no other. */
export function stepBatch(characters, dt) {
  let advanced = 0;
  const refusals = [];
  for (let index = 0; index < characters.length; index++) {
    try {
      if (characters[index].step(dt)) advanced++;
    } catch (error) {
      refusals.push({ index, error });
    }
  }
  return { advanced, refusals };
}
