// What the page says: messages that stay until closed, and progress.

const message = document.querySelector('#message');
const busyBox = document.querySelector('#busy');
message.querySelector('button').addEventListener('click', () => hideMessage());

export function hideMessage() {
  message.hidden = true;
}

/** Shows a problem and its remedy. @param {boolean} [fatal] nothing else works either */
export function showProblem(problem, fatal = false) {
  message.querySelector('strong').textContent = problem.message;
  message.querySelector('p').textContent = problem.remedy ?? '';
  message.classList.toggle('fatal', fatal);
  message.hidden = false;
}

let latest = 0; // of several tasks, the last one is shown

/** Shows `what` and the seconds gone by until `task` has ended. */
export async function busy(what, task) {
  const text = busyBox.querySelector('span');
  const own = ++latest;
  const since = performance.now();
  const tell = () => {
    if (own !== latest) return;
    const seconds = Math.floor((performance.now() - since) / 1000);
    text.textContent = seconds > 0 ? `${what} · ${seconds} s` : what;
  };
  tell();
  busyBox.hidden = false;
  const timer = setInterval(tell, 250);
  try {
    return await task();
  } finally {
    clearInterval(timer);
    if (own === latest) busyBox.hidden = true;
  }
}
