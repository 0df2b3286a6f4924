/** An error with a stable name for programs; its text may change. */
export const coded = (code, message, Type = Error) => Object.assign(new Type(message), { code });
