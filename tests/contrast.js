// The texts of a page whose contrast with what lies behind them is below 4.5, as an array of sentences.
(() => {
  const rgb = (text) => text.match(/[\d.]+/g).map(Number);
  const behind = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const [r, g, b, opacity = 1] = rgb(getComputedStyle(at).backgroundColor);
      if (opacity === 1) return [r, g, b];
    }
    return [255, 255, 255];
  };
  // Relative luminance, as WCAG defines it.
  const luminance = (colour) => {
    const [r, g, b] = colour.map((each) => each / 255).map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ratio = (one, other) => {
    const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  };
  // On the stage: letters on their object, all other words on the darker or lighter of the table's two colours.
  const onStage = (element) => {
    if (element.matches(".wa-letter")) return [rgb(getComputedStyle(element.parentElement.querySelector(".wa-body")).fill)];
    const style = getComputedStyle(element);
    return ["--wa-card", "--wa-well"].map((name) => {
      const hex = style.getPropertyValue(name).trim();
      return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
    });
  };
  const faults = [];
  for (const element of document.querySelectorAll("body *")) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!own || element.matches("script, style, noscript, option, :disabled") || !element.getClientRects().length) continue;
    const inSvg = element.namespaceURI.endsWith("svg");
    const colour = rgb(getComputedStyle(element)[inSvg ? "fill" : "color"]);
    for (const ground of inSvg ? onStage(element) : [behind(element)]) {
      const found = ratio(colour.slice(0, 3), ground);
      if (found < 4.5) faults.push(`${element.textContent.trim().slice(0, 30)}: ${found.toFixed(2)}`);
    }
  }
  return faults;
})()
