// Sections that have moved to another page. Old links to them lead to the new page: VitePress has no redirects.

interface Moved {
  /** The new address of each anchor that has left the page. */
  anchors?: Record<string, string>
  /** The page of all other anchors that this page lacks. */
  others?: string
}

/** By page, without its extension. Addresses are relative to the page. */
export const MOVED: Record<string, Moved> = {
  'guides/connection': {
    anchors: { several: 'connection-robot.html#several', data: 'data-port.html' },
  },
  'guides/performance': { others: 'performance-results.html' },
  'guides/promises': {
    anchors: {
      limits: 'limits.html',
      packages: 'packages.html',
      scripts: 'testing.html#scripts',
      chaos: 'testing.html#chaos',
      faults: 'testing.html#faults',
      fuzzing: 'testing.html#fuzzing',
      load: 'testing.html#load',
      watching: 'operations.html#watching',
    },
  },
}

/** A script for the head of a page. It opens the new address of an anchor. */
export function leadOn({ anchors = {}, others }: Moved): string {
  const known = `const to=new Map(${JSON.stringify(Object.entries(anchors))}).get(a)
if(to)location.replace(to)`
  const unknown = `
else addEventListener('DOMContentLoaded',()=>{if(!document.getElementById(a))location.replace('${others}'+location.hash)})`
  return `(()=>{let a;try{a=decodeURIComponent(location.hash.slice(1))}catch{}
if(!a)return
${known}${others ? unknown : ''}})()`
}

/** The moved sections of a page, by its file: `en/guides/promises.md`. */
export const movedFrom = (file: string): Moved | undefined => MOVED[file.replace(/^en\//, '').replace(/\.md$/, '')]
