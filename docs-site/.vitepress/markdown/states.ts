// Converts a state diagram of the generated pages to the rows of the site's picture.

/** A state, with marks for the start and the end of a process. */
export interface State {
  name: string
  starts: boolean
  ends: boolean
}

/** Consecutive states. `choice` has the possible successors of the last one if there are several. */
export interface Chain {
  states: State[]
  choice: string[]
}

/** `state "name" as s0`, the name of a box; `s0 --> s1`, an arrow. `[*]` is the start or the end of a process. */
const BOX = /^\s*state "(.+)" as (\S+)$/
const CHANGE = /^\s*(\S+) --> (\S+)$/
const OUTSIDE = '[*]'

type Box = State & { then: Box[] }

function boxes(text: string): Box[] {
  const boxes = new Map<string, Box>()
  const named = (id: string, line: string) => {
    const box = boxes.get(id)
    if (!box) throw new Error(`a state diagram has no box for: ${line}`)
    return box
  }
  for (const line of text.trim().split('\n').slice(1)) {
    const box = BOX.exec(line)
    const change = CHANGE.exec(line)
    if (box) boxes.set(box[2], { name: box[1], then: [], starts: false, ends: false })
    else if (!change) throw new Error(`a line of a state diagram is not drawn: ${line}`)
    else if (change[1] === OUTSIDE) named(change[2], line).starts = true
    else if (change[2] === OUTSIDE) named(change[1], line).ends = true
    else named(change[1], line).then.push(named(change[2], line))
  }
  return [...boxes.values()]
}

/**
 * The rows of a diagram. A row continues while exactly one state follows. Each arrow is in one row. Rows with the
 * start of a process come first.
 */
export function chains(text: string): Chain[] {
  const all = boxes(text)
  const left = new Set(all.filter(({ then }) => then.length > 0))
  const follows = (box: Box) => all.some(({ then }) => then.includes(box))
  const chain = (first: Box): Chain => {
    const boxes = [first]
    const row = (choice: Box[]) => ({
      states: boxes.map(({ name, starts, ends }) => ({ name, starts, ends })),
      choice: choice.map(({ name }) => name),
    })
    for (let last = first; ; boxes.push(last)) {
      // The process ends there, or continues in another row.
      if (!left.delete(last)) return row([])
      if (last.then.length > 1) return row(last.then)
      last = last.then[0]
    }
  }
  const heads = [
    ...all.filter(({ starts }) => starts),
    ...all.filter((box) => !box.starts && !follows(box)),
    // The rest follows a row above or is a circle.
    ...all,
  ]
  const rows: Chain[] = []
  for (const box of heads) if (left.has(box)) rows.push(chain(box))
  const lone = all.filter((box) => box.then.length === 0 && !follows(box))
  return [...rows, ...lone.map(chain)]
}
