// The chosen language of code samples. All tabs follow it, on this page and on pages opened later.

/** The key in the browser's storage. */
const KEY = 'fc-code'

/** The buttons of a language that are not pressed. */
const WAITING = '.fc-samples > input:not(:checked)'

function remembered(): string | null {
  try {
    return localStorage.getItem(KEY)
  } catch {
    return null
  }
}

/** Presses the buttons of a language. Rows without a tab for it keep the first one. */
function press(language: string | null): void {
  for (const button of document.querySelectorAll<HTMLInputElement>(WAITING)) {
    if (button.value === language) button.checked = true
  }
}

/** Shows the chosen language on a new page. */
export const pressRemembered = () => press(remembered())

/** Stores the choice and updates the other tabs. The pressed button keeps its position on the screen. */
export function followChoice(): void {
  document.addEventListener('change', ({ target }) => {
    if (!(target instanceof HTMLInputElement) || !target.matches('.fc-samples > input')) return
    try {
      localStorage.setItem(KEY, target.value)
    } catch {
      // Without storage, the reader chooses again on each page.
    }
    const row = target.parentElement!
    const before = row.getBoundingClientRect().top
    press(target.value)
    scrollBy({ top: row.getBoundingClientRect().top - before, behavior: 'instant' })
  })
}

/**
 * The same for the first page, as a script in its head. It presses the buttons while the browser reads the page, before
 * the first paint.
 */
export const PRESS_AT_ONCE = `(()=>{let c;try{c=localStorage.getItem('${KEY}')}catch{}
if(!c)return
const p=()=>{for(const b of document.querySelectorAll('${WAITING}'))if(b.value===c)b.checked=true}
const o=new MutationObserver(p)
o.observe(document,{childList:true,subtree:true})
addEventListener('DOMContentLoaded',()=>{p();o.disconnect()})})()`
