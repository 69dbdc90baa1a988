// Small helpers for building controls.

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: { [name: string]: string } = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export function button(
  text: string,
  attributes: { [name: string]: string },
  pressed: () => void,
): HTMLButtonElement {
  const element = make("button", { type: "button", ...attributes }, text);
  element.addEventListener("click", pressed);
  return element;
}

/** A checkbox with its label. */
export function checkbox(
  text: string,
  checked: boolean,
  changed: (checked: boolean) => void,
): HTMLLabelElement {
  const input = make("input", { type: "checkbox" });
  input.checked = checked;
  input.addEventListener("change", () => changed(input.checked));
  return make("label", { class: "choice" }, input, text);
}

/** Radio buttons under one legend. */
export function radios(
  legend: string,
  name: string,
  choices: [string, string][],
  chosen: string,
  changed: (value: string) => void,
): HTMLFieldSetElement {
  const set = make("fieldset", { class: "choices" }, make("legend", {}, legend));
  for (const [value, text] of choices) {
    const input = make("input", { type: "radio", name, value });
    input.checked = value === chosen;
    input.addEventListener("change", () => {
      if (input.checked) changed(value);
    });
    set.append(make("label", { class: "choice" }, input, text));
  }
  return set;
}

/** A drop-down list with its label. */
export function dropdown(
  text: string,
  choices: [string, string][],
  chosen: string,
  changed: (value: string) => void,
): HTMLLabelElement {
  const select = make("select");
  for (const [value, label] of choices) {
    const option = make("option", { value }, label);
    option.selected = value === chosen;
    select.append(option);
  }
  select.addEventListener("change", () => changed(select.value));
  return make("label", { class: "choice" }, text, select);
}

export function reduced_motion(): boolean {
  return window.matchMedia("(prefers-reduced-motion: reduce)").matches;
}
