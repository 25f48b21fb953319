// JSON as people read and write it.

/** Indents JSON without parsing numbers, which would round 64-bit ids. */
export function indent(text: string): string {
  let depth = 0
  const line = () => '\n' + '  '.repeat(depth)
  return text.replace(/("(?:[^"\\]|\\.)*")|\s+|([{[])(?:\s*([}\]]))?|([}\]])|(,)|(:)/g, (_, string, open, shut, close, comma, colon) => {
    if (string !== undefined) return string
    if (open) {
      if (shut) return open + shut
      depth++
      return open + line()
    }
    if (close) {
      depth--
      return line() + close
    }
    if (comma) return ',' + line()
    return colon ? ': ' : ''
  })
}

/** Returns the text without comments outside strings; `null` if it has none. */
export function withoutComments(text: string): string | null {
  let found = false
  const bare = text.replace(/("(?:[^"\\\n]|\\.)*")|[ \t]*\/\/[^\n]*|[ \t]*\/\*[^]*?\*\//g, (_, string) => {
    if (string !== undefined) return string
    found = true
    return ''
  })
  return found ? bare : null
}
