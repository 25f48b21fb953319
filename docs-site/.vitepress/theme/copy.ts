// Copies a text. On a page over plain HTTP, such as a site on a local network, browsers offer no clipboard.

/** Returns `true` if the text is now on the clipboard. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text)
    return true
  } catch {
    return copyBySelection(text)
  }
}

function copyBySelection(text: string): boolean {
  const focused = document.activeElement
  const area = document.createElement('textarea')
  area.value = text
  area.readOnly = true
  area.style.cssText = 'position: fixed; left: -9999px; top: 0; font-size: 12pt'
  document.body.append(area)
  area.select()
  // iOS selects nothing in a read-only element without a range.
  area.setSelectionRange(0, text.length)
  let copied = false
  try {
    copied = document.execCommand('copy')
  } finally {
    area.remove()
    if (focused instanceof HTMLElement) focused.focus()
  }
  return copied
}
