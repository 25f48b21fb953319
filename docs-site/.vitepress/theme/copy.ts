// Copying, also where the browser has no clipboard to offer: it has none on a page over plain http,
// such as a site on a local network.

/** Whether the text is on the clipboard now. */
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
  // iOS selects nothing in what is read-only unless told where.
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
