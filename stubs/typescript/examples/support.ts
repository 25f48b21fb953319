// Shared by the examples: their command line, and a table with aligned columns.

/** The command line: address and ports of the robot, and options. */
export interface Args {
  /** Address of the robot. */
  host: string
  /** Port of commands; absent for the spec's. */
  commandPort?: number
  /** Port of streams; absent for the spec's. */
  dataPort?: number
  /** Ends the robot once its app has left. */
  once: boolean
  /** Time the robot takes for each command, in milliseconds. */
  delay: number
  /** Least number of bytes to compress; absent for the default. */
  gzip: { fromBytes?: number }
  /** Factor for the width and height of the robot's picture. */
  pictureScale: number
  /** Language of the output. */
  lang: 'zh' | 'en'
}

/** Runs an example with its command line. Exits with 2 for a wrong command line, with 1 for an error. */
export async function main(usage: string, run: (args: Args) => Promise<void>): Promise<void> {
  let args: Args
  try {
    const words = process.argv.slice(2)
    if (words.includes('--help') || words.includes('-h')) {
      console.log(usage)
      return
    }
    args = parse(words)
  } catch (problem) {
    console.error(`${(problem as Error).message}\n\n${usage}`)
    process.exitCode = 2
    return
  }
  try {
    await run(args)
  } catch (problem) {
    console.error(problem instanceof Error ? problem.message : problem)
    process.exitCode = 1
  }
}

/** Returns the language of the environment, as POSIX specifies. */
function langOfEnvironment(): Args['lang'] {
  const { LC_ALL, LC_MESSAGES, LANG } = process.env
  return [LC_ALL, LC_MESSAGES, LANG].find((locale) => locale)?.startsWith('zh') ? 'zh' : 'en'
}

function parse(words: readonly string[]): Args {
  const args: Args = {
    host: '127.0.0.1',
    once: false,
    delay: 0,
    gzip: {},
    pictureScale: 1,
    lang: langOfEnvironment(),
  }
  for (let index = 0; index < words.length; index++) {
    const word = words[index] ?? ''
    const value = (): string => {
      const next = words[++index]
      if (next === undefined) throw new Error(`${word} needs a value`)
      return next
    }
    const number = (most: number): number => {
      const text = value()
      if (!/^[0-9]+$/.test(text) || Number(text) > most) throw new Error(`${text} is no number up to ${most}`)
      return Number(text)
    }
    if (word === '--host') args.host = value()
    else if (word === '--command-port') args.commandPort = number(65535)
    else if (word === '--data-port') args.dataPort = number(65535)
    else if (word === '--delay') args.delay = number(2 ** 31 - 1)
    else if (word === '--gzip-from') args.gzip = { fromBytes: number(2 ** 31 - 1) }
    else if (word === '--picture-scale') args.pictureScale = number(100)
    else if (word === '--once') args.once = true
    else if (word === '--lang') {
      const lang = value()
      if (lang !== 'zh' && lang !== 'en') throw new Error(`${lang} is neither zh nor en`)
      args.lang = lang
    } else throw new Error(`${word} is no option`)
  }
  return args
}

/** Returns the given ports as settings. */
export const ports = ({ commandPort, dataPort }: Args): { commandPort?: number; dataPort?: number } => ({
  ...(commandPort === undefined ? {} : { commandPort }),
  ...(dataPort === undefined ? {} : { dataPort }),
})

/** Returns the columns of a text on a terminal, where a Chinese character takes two. */
const width = (text: string): number =>
  [...text].reduce(
    (sum, character) =>
      sum +
      (/[\u1100-\u115f\u2e80-\u303e\u3041-\ua4cf\uac00-\ud7a3\uf900-\ufaff\ufe30-\ufe4f\uff00-\uff60\uffe0-\uffe6]/.test(
        character,
      )
        ? 2
        : 1),
    0,
  )

/** Formats rows of cells, with each column as wide as its widest cell. */
export function table(rows: readonly (readonly string[])[]): string {
  const widths = (rows[0] ?? []).map((_, column) => Math.max(...rows.map((row) => width(row[column] ?? ''))))
  const line = (row: readonly string[]): string =>
    row
      .map((cell, column) => cell + ' '.repeat((widths[column] ?? 0) - width(cell)))
      .join('  ')
      .trimEnd()
  return rows.map(line).join('\n')
}

/** Returns the value, or rejects after this many milliseconds. */
export async function within<T>(milliseconds: number, what: string, value: Promise<T>): Promise<T> {
  let timer: NodeJS.Timeout | undefined
  const late = new Promise<never>((_, reject) => {
    timer = setTimeout(() => {
      reject(new Error(what))
    }, milliseconds)
  })
  try {
    return await Promise.race([value, late])
  } finally {
    clearTimeout(timer)
  }
}
