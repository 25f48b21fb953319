package fc.runtime

import java.io.File
import java.util.TreeMap
import kotlin.system.exitProcess

/** Counts tests and failures. */
internal class Tests(
    /** The root of the project, with the vectors and scripts of all languages. */
    val root: File,
) {
    private var cases = 0
    private var failed = 0
    private val held = TreeMap<String, Int>()

    /**
     * Runs a case, which fails if [body] throws. [kind] is from `conformance/README.md` if all languages have the case.
     */
    inline fun case(name: String, kind: String? = null, body: () -> Unit) {
        cases++
        try {
            body()
            kind?.let { held.merge(it, 1, Int::plus) }
        } catch (error: Throwable) {
            failed++
            println("$name: $error")
            if (error !is Wrong) error.stackTrace.take(12).forEach { println("    at $it") }
        }
    }

    /** Runs a suite. It fails with fewer than [atLeast] cases. */
    fun suite(name: String, atLeast: Int, run: (Tests) -> Unit) {
        val before = cases
        run(this)
        val seen = cases - before
        println("$name: $seen cases")
        case("$name: the number of cases") { expect(true, seen >= atLeast) }
    }

    fun files(folder: String): List<File> =
        File(root, folder).listFiles { file -> file.extension == "json" }.orEmpty().sortedBy { it.name }

    /** Ends the run. Appends a line `KIND NUMBER` for each kind to the file in `FC_CONFORMANCE`, if set. */
    fun end(): Nothing {
        System.getenv("FC_CONFORMANCE")?.let { path ->
            File(path).appendText(held.entries.joinToString("") { (kind, number) -> "$kind $number\n" })
        }
        println("$cases cases, $failed failed")
        exitProcess(if (failed == 0) 0 else 1)
    }
}

/** A failed expectation. */
internal class Wrong(message: String) : Exception(message)

internal fun expect(expected: Any?, found: Any?, what: () -> String = { "" }) {
    if (expected != found) throw Wrong("${what()} expected $expected, found $found")
}

/** Returns the name of the error, or `null` if there is none. */
internal inline fun errorOf(body: () -> Unit): String? = try {
    body()
    null
} catch (error: BodyError) {
    error.name
} catch (error: FrameError) {
    error.name
}

internal fun hex(text: String): ByteArray = ByteArray(text.length / 2) { text.substring(2 * it, 2 * it + 2).toInt(16).toByte() }

internal fun hex(bytes: ByteArray): String = bytes.joinToString("") { String.format("%02x", it) }

/** A JSON value from a test file. */
internal class Tree(
    /** The text of a string, number or word. */
    val text: String,
    val items: List<Tree> = emptyList(),
    val keys: Map<String, Tree> = emptyMap(),
    private val kind: Char = '0',
) {
    operator fun get(key: String): Tree = keys.getValue(key)

    fun find(key: String): Tree? = keys[key]?.takeIf { it.text != "null" || it.kind == '"' }

    val int: Int get() = text.toInt()
    val long: Long get() = text.toLong()

    /** Ignores the order of keys and the spelling of numbers. */
    override fun equals(other: Any?): Boolean =
        other is Tree && kind == other.kind && items == other.items && keys == other.keys && sameText(other)

    private fun sameText(other: Tree): Boolean =
        text == other.text || kind == '0' && (text.toBigDecimalOrNull()?.compareTo(other.text.toBigDecimalOrNull() ?: return false) == 0)

    override fun hashCode(): Int = keys.size

    override fun toString(): String = when (kind) {
        '{' -> keys.entries.joinToString(",", "{", "}") { "\"${it.key}\":${it.value}" }
        '[' -> items.joinToString(",", "[", "]")
        '"' -> "\"$text\""
        else -> text
    }

    companion object {
        fun of(file: File): Tree = of(file.readText())

        fun of(text: String): Tree = of(JsonReader(text, Allowance.ANY))

        private fun of(reader: JsonReader): Tree = when (reader.peek()) {
            '{' -> {
                val keys = LinkedHashMap<String, Tree>()
                reader.beginObject()
                while (!reader.endObject()) {
                    val key = reader.key()
                    keys[key] = of(reader)
                    reader.endValue()
                }
                Tree("", keys = keys, kind = '{')
            }
            '[' -> Tree("", items = reader.list(8) { of(reader) }, kind = '[')
            '"' -> Tree(reader.string(), kind = '"')
            else -> Tree(reader.valueText())
        }
    }
}
