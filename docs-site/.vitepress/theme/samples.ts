// The language that a reader has chosen for code: all tabs follow it, on this page and on those opened later.

/** Where the browser keeps it. */
const KEY = 'fc-code'

/** Its buttons that are not pressed. */
const WAITING = '.fc-samples > input:not(:checked)'

function remembered(): string | null {
  try {
    return localStorage.getItem(KEY)
  } catch {
    return null
  }
}

/** Presses the buttons of a language; where it has no tab, the first one stays. */
function press(language: string | null): void {
  for (const button of document.querySelectorAll<HTMLInputElement>(WAITING)) {
    if (button.value === language) button.checked = true
  }
}

/** Shows the language chosen before, on a page that has just been shown. */
export const pressRemembered = () => press(remembered())

/** Remembers what is chosen, and lets the other tabs follow. What was pressed stays where it is on the screen. */
export function followChoice(): void {
  document.addEventListener('change', ({ target }) => {
    if (!(target instanceof HTMLInputElement) || !target.matches('.fc-samples > input')) return
    try {
      localStorage.setItem(KEY, target.value)
    } catch {
      // Who allows no storage chooses on each page.
    }
    const row = target.parentElement!
    const before = row.getBoundingClientRect().top
    press(target.value)
    scrollBy({ top: row.getBoundingClientRect().top - before, behavior: 'instant' })
  })
}

/**
 * The same for the first page, as a script in its head: buttons are pressed while the page is read, before anything of it is
 * painted.
 */
export const PRESS_AT_ONCE = `(()=>{let c;try{c=localStorage.getItem('${KEY}')}catch{}
if(!c)return
const p=()=>{for(const b of document.querySelectorAll('${WAITING}'))if(b.value===c)b.checked=true}
const o=new MutationObserver(p)
o.observe(document,{childList:true,subtree:true})
addEventListener('DOMContentLoaded',()=>{p();o.disconnect()})})()`
