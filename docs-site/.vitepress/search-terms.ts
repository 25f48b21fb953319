// The local search: by which terms a page is found, which page comes first, and what is shown of it.
//
// VitePress ships these functions to the browser as text, so each must stand on its own: no imports, no helpers
// outside its body.

/** Begins terms of a section that are searched and not shown. The functions below spell it themselves. */
export const HIDDEN = '\u2063'

/**
 * Terms of a page: its words and numbers. A name gives its parts as well, and itself without strokes: `robot_sn` →
 * `robot`, `sn`, `robotsn`. A hexadecimal number is also found bare and without its zeros: `0x0A01` → `0A01`, `A01`.
 * Chinese has no spaces to split at: every pair of neighbouring characters is a term.
 */
export function indexTerms(text: string): string[] {
  const terms: string[] = []
  for (const run of text.match(/[A-Za-z0-9_]+|[\u3400-\u9fff\uf900-\ufaff]+/g) ?? []) {
    if (/^0[xX][0-9A-Fa-f]+$/.test(run)) {
      const bare = run.slice(2)
      const short = bare.replace(/^0+(?=.)/, '')
      terms.push(run, bare)
      if (short !== bare) terms.push(short, '0x' + short)
    } else if (/^[A-Za-z0-9_]/.test(run)) {
      terms.push(run)
      const parts = run.split(/_+|(?<=[a-z0-9])(?=[A-Z])/).filter(Boolean)
      if (parts.length > 1) terms.push(...parts)
      if (run.includes('_')) terms.push(parts.join(''))
    } else {
      for (const character of run) terms.push(character)
      for (let at = 0; at + 1 < run.length; at++) terms.push(run.slice(at, at + 2))
    }
  }
  return terms
}

/**
 * Terms of a query: its words. A name gives its parts, joined in every way that a language may join them; a code gives
 * the block of codes around it. Chinese gives pairs, and a single character only where the query has no more: else every
 * page would match 电 when asked for 充电. Words that only ask (how, 怎么) are left out, unless the query has no others.
 */
export function queryTerms(query: string): string[] {
  const terms = (text: string) => {
    const found: string[] = []
    for (const run of text.match(/[A-Za-z0-9_]+|[\u3400-\u9fff\uf900-\ufaff]+/g) ?? []) {
      if (/^0[xX][0-9A-Fa-f]{1,4}$/.test(run)) {
        const code = `0x${run.slice(2).padStart(4, '0')}`
        found.push(run, `${code.slice(0, 4)}xx`, `${code.slice(0, 5)}x`)
      } else if (/^[A-Za-z0-9_]/.test(run)) {
        found.push(run)
        // `GetRobotSnRequest`: what lies in it is found although no page has the whole.
        const parts = run.split(/_+|(?<=[a-z0-9])(?=[A-Z])/).filter(Boolean)
        if (parts.length < 2 || parts.length > 8) continue
        for (let from = 0; from < parts.length; from++) {
          for (let to = from + 1; to <= parts.length; to++) found.push(parts.slice(from, to).join(''))
        }
      } else if (run.length === 1) found.push(run)
      else for (let at = 0; at + 1 < run.length; at++) found.push(run.slice(at, at + 2))
    }
    return found
  }
  const told = query
    .replace(/怎么样|怎么办|怎么|怎样|如何|为什么|什么|是多少|多少|请问|哪些|哪个|哪里|有没有|能不能|可以|(?<!目)的|吗|呢/g, ' ')
    .replace(
      /\b(?:how|what|which|where|when|why|who|is|are|was|do|does|did|can|could|should|i|we|you|my|it|its|the|a|an|of|to|in|on|for|from|by|with|and|or|there|please)\b/gi,
      ' ',
    )
  const found = terms(told)
  return found.length ? found : terms(query)
}

/**
 * How much a hit counts by its page: the head of an operation's page most, then pages about all operations, then lists.
 * Pages for the authors of the spec come last.
 */
export function weight(id: string, _term: string, stored?: Record<string, unknown>): number {
  const page = id.split('#')[0]
  let weight = 1
  if (/\/reference\/(commands|reports|streams)\//.test(page)) weight = 3
  else if (/\/reference\/(wire|results)\.html$/.test(page)) weight = 2
  else if (/\/reference\/codes\.html$|\/reference\/$/.test(page)) weight = 0.4
  else if (/\/reference\/(changelog|open-questions)\.html$/.test(page)) weight = 0.1
  // The owner of the protocol needs these.
  else if (/\/reference\/(language|errors|cli)\.html$/.test(page)) weight = 0.1
  else if (/\/guides\/(adding-a-command|changing-safely|editors|answers|releases|targets|lint|what-changed)\.html$/.test(page)) weight = 0.3
  // A section under no other is the head of its page.
  const head = Array.isArray(stored?.titles) && stored.titles.length === 0
  return head ? weight * 3 : weight
}

/**
 * What is done with each hit before they are sorted. One that has more of the words of the query comes before
 * one that has fewer, so that a long question still finds something and an exact one finds its page first.
 *
 * And it is shown with the text around it: the heading joins the path above it, and the text takes its place, since
 * VitePress has no other line for it. Its own excerpts fetch and draw the whole page of every hit.
 */
export function finish(hit: Record<string, any>): boolean {
  hit.score *= 4 ** new Set(hit.queryTerms).size
  const text = String(hit.text ?? '')
    .replace(/\u2063[^]*$/, '')
    .replace(/&(?:#\w+|\w+);/g, (entity) => ({ '&quot;': '"', '&#39;': "'", '&amp;': '&' })[entity] ?? ' ')
    .replace(/\s+/g, ' ')
    .trim()
  const lower = text.toLowerCase()
  // The longest of its words says most: a pair before one character.
  const words = [...hit.terms].sort((a: string, b: string) => b.length - a.length)
  const at = words.map((word: string) => lower.indexOf(word)).find((place) => place >= 0) ?? 0
  const chinese = /[\u3400-\u9fff]/.test(text.slice(at, at + 40))
  const [before, after] = chinese ? [12, 48] : [30, 110]
  let from = Math.max(0, at - before)
  // No word is cut at the start.
  if (from > 0 && !chinese) from = text.indexOf(' ', from) + 1 || from
  const excerpt = (from > 0 ? '…' : '') + text.slice(from, at + after) + (at + after < text.length ? '…' : '')
  if (text) Object.assign(hit, { titles: [...hit.titles, hit.title], title: excerpt.replace(/[<>&]/g, ' ') })
  return true
}

/** Options of the index, and of a search in it. */
export const miniSearch = {
  options: { tokenize: indexTerms, storeFields: ['title', 'titles', 'text'] },
  searchOptions: {
    tokenize: queryTerms,
    combineWith: 'OR' as const,
    fuzzy: false,
    prefix: true,
    boost: { title: 6, titles: 2, text: 1 },
    boostDocument: weight,
    filter: finish,
  },
}
