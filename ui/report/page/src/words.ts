// The page's words in the report's language: the program writes the translations into the data (ui/report/report_data.cpp), xgettext finds the messages here.

let translations: { [english: string]: string } = {};
let sign = ".";

export function set_words(
  words: { [english: string]: string } | undefined,
  decimal_sign: string | undefined,
): void {
  translations = words ?? {};
  sign = decimal_sign ?? ".";
}

/** The message in the report's language, with `texts` in its gaps `{}`, or `{0}`, `{1}`; numbers with its decimal sign. */
export function tr(english: string, ...texts: (string | number)[]): string {
  let next = 0;
  const said_so = (text: string | number): string =>
    typeof text === "number" ? with_sign(String(text)) : text;
  return (translations[english] ?? english).replace(/\{(\d*)\}/g, (_gap, number: string) =>
    said_so(texts[number === "" ? next++ : Number(number)] ?? ""),
  );
}

/** Marks a message that is shown later by tr(). */
export function noop(english: string): string {
  return english;
}

/** A number with `digits` decimals. */
export function fixed(v: number, digits: number): string {
  return v.toFixed(digits).replace(".", sign);
}

/** A number that was written with a decimal point. */
export function with_sign(text: string): string {
  return sign === "." ? text : text.replace(/[.,]/g, (c) => (c === "." ? sign : "."));
}
