(() => {
  // What lies in a scroll container, or is folded away, may lie outside the window.
  const held = (element) => element.closest(".scroll, pre");
  const width = document.documentElement.clientWidth;
  const outside = [];
  const clipped = [];
  for (const element of document.body.querySelectorAll("*")) {
    const box = element.getBoundingClientRect();
    if (!box.width || !box.height || held(element.parentElement) || element.closest(".skip")) continue;
    const name = `${element.tagName.toLowerCase()}#${element.id}.${element.className}: ${element.textContent.trim().slice(0, 40)}`;
    if (box.left < -0.5 || box.right > width + 0.5 || box.top + scrollY < -0.5) outside.push(name);
    // Text that is larger than its box, where what is larger is hidden.
    const style = getComputedStyle(element);
    if (!element.matches(".scroll, pre") && style.overflowX !== "visible"
        && (element.scrollWidth > element.clientWidth + 1)) clipped.push(name);
  }
  const box = document.querySelector(".verdict .sentence, .verdict h1")?.getBoundingClientRect();
  return {
    width, height: innerHeight, scrolled: scrollY,
    document_width: document.documentElement.scrollWidth,
    outside, clipped,
    headline: box ? [box.left, box.top, box.right, box.bottom] : null,
    headline_text: document.querySelector(".verdict .sentence, .verdict h1")?.textContent.trim() ?? "",
    images: [...document.images].map((image) => ({
      name: image.closest("figure")?.id ?? "", alt: image.alt,
      natural: image.naturalWidth, width: image.getBoundingClientRect().width,
      caption: image.closest("figure")?.querySelector("figcaption")?.textContent.trim() ?? "",
    })),
    tables: [...document.querySelectorAll("table")].map((table) => ({
      name: table.closest(".table")?.id ?? "",
      rows: table.querySelectorAll("tbody tr:not(.heading)").length,
      heads: table.querySelectorAll("thead th").length,
    })),
    background: getComputedStyle(document.body).backgroundColor,
    ink: getComputedStyle(document.body).color,
    links: [...document.links].map((link) => link.getAttribute("href")),
  };
})()
