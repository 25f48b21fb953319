// Finds unreadable text: outside of the page or its box, or over other text.

/** The views of a page. Paper is as wide as an A4 page without the margins of browsers. */
export const VIEWS = [
  { name: '390 px', width: 390, height: 844, media: 'screen' },
  { name: '820 px', width: 820, height: 1180, media: 'screen' },
  { name: '1440 px', width: 1440, height: 900, media: 'screen' },
  { name: 'print', width: 717, height: 1020, media: 'print' },
]

/** Shows the page in a view. */
export async function look(page, { width, height, media }) {
  await page.emulateMedia({ media })
  await page.setViewportSize({ width, height })
}

/**
 * `{ counts, cut }` of the shown page: the numbers of tables, samples, pictures and badges, and each one with an
 * unreadable part. Code samples may scroll on a screen.
 */
export const cut = (page, { media }) => page.evaluate(find, media === 'print')

function find(print) {
  const KINDS = [
    ['table', 'table'],
    ['code', 'div[class*="language-"]'],
    ['picture', 'svg, .fc-ruler, .fc-frame, .fc-layouts'],
    ['badge', '.fc-badge'],
  ]
  const main = document.querySelector('.VPContent')
  const counts = Object.fromEntries(KINDS.map(([kind, selector]) => [kind, main.querySelectorAll(selector).length]))
  const seen = new Map()
  const wide = document.documentElement.clientWidth
  const style = new Map()
  const styleOf = (element) => {
    if (!style.has(element)) style.set(element, getComputedStyle(element))
    return style.get(element)
  }
  const box = new Map()
  const boxOf = (element) => {
    if (!box.has(element)) box.set(element, element.getBoundingClientRect())
    return box.get(element)
  }
  const found = (element, why, text) => {
    const kind = KINDS.find(([, selector]) => element.closest(selector))
    const place = kind ? element.closest(kind[1]) : element
    if (!seen.has(place)) seen.set(place, `${kind?.[0] ?? place.tagName.toLowerCase() + (place.className?.baseVal ?? place.className ? '.' + place.className : '')}: ${why}: ${text.trim().slice(0, 40)}`)
  }

  /** Returns `true` if no element between a rectangle and the page cuts it off. */
  const examine = (element, rect, text) => {
    if (rect.right > wide + 1 || rect.left < -1) {
      found(element, 'off the page', text)
      return false
    }
    for (let at = element; at && at !== main; at = at.parentElement) {
      const { overflowX, overflowY, display } = styleOf(at)
      const cell = /^(TD|TH)$/.test(at.tagName)
      if (display === 'inline') continue
      const { left, right, top, bottom } = boxOf(at)
      if ((overflowX !== 'visible' || cell) && (rect.right > right + 1 || rect.left < left - 1)) {
        found(element, 'cut at the side', text)
        return false
      }
      const shut = overflowY === 'hidden' || overflowY === 'clip' || (print && overflowY !== 'visible')
      if (shut && (rect.bottom > bottom + 3 || rect.top < top - 3)) {
        found(element, 'cut below', text)
        return false
      }
    }
    return true
  }

  const texts = []
  const walker = document.createTreeWalker(main, NodeFilter.SHOW_TEXT)
  const range = document.createRange()
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    if (!/[^\s\u200b]/.test(node.data)) continue
    const element = node.parentElement
    if (element.closest('textarea, select, style, script, title, .visually-hidden')) continue
    // The content of a scrolling element counts as visible. Only its box must be whole.
    if (!print && element.closest('div[class*="language-"] pre')) continue
    if (!element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue
    range.selectNodeContents(node)
    for (const rect of range.getClientRects()) {
      if (rect.width < 1 || rect.height < 1) continue
      const whole = examine(element, rect, node.data)
      if (whole && !element.closest('pre')) texts.push({ element, rect, text: node.data })
    }
  }
  for (const sample of main.querySelectorAll('div[class*="language-"]')) {
    if (boxOf(sample).right > wide + 1) found(sample, 'off the page', sample.textContent)
  }

  // Names in a picture stay within their box.
  for (const shape of main.querySelectorAll('svg [data-within]')) {
    const outer = shape.parentElement.querySelector(shape.dataset.within)
    const [a, b] = [boxOf(shape), boxOf(outer)]
    if (a.left < b.left || a.right > b.right || a.top < b.top || a.bottom > b.bottom) found(shape, 'outside of its box', shape.textContent)
  }

  // Text over text, by more than the slack between two lines.
  texts.sort((a, b) => a.rect.top - b.rect.top)
  texts.forEach((one, index) => {
    for (let next = index + 1; next < texts.length && texts[next].rect.top < one.rect.bottom; next++) {
      const [a, b] = [one.rect, texts[next].rect]
      const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left)
      if (across > 2 && high > 0.5 * Math.min(a.height, b.height)) found(one.element, `under "${texts[next].text.trim().slice(0, 20)}"`, one.text)
    }
  })
  return { counts, cut: [...seen.values()] }
}
