package fc.examples

import fc.runtime.ClientConfig
import fc.runtime.Gzip
import java.util.concurrent.TimeUnit
import kotlin.system.exitProcess

/** The command line: the host, both ports, and options for tests. */
internal class Arguments(arguments: Array<String>, private val usage: String) {
    private val given = HashMap<String, String>()

    init {
        val words = arguments.iterator()
        while (words.hasNext()) {
            val word = words.next()
            if (word == "--help") {
                println(usage)
                exitProcess(0)
            }
            if (word !in OPTIONS || !words.hasNext()) refuse("there is no option `$word` with that value")
            given[word] = words.next()
        }
        if (host.isBlank()) refuse("`--host` is empty")
    }

    private fun refuse(why: String): Nothing {
        System.err.println("$why\n\n$usage")
        exitProcess(2)
    }

    /** Returns the number of an option. */
    private fun number(option: String, most: Int, least: Int = 0): Int? {
        val given = given[option] ?: return null
        return given.toIntOrNull()?.takeIf { it in least..most }
            ?: refuse("`$option` is $given, expected an integer from $least to $most")
    }

    val host: String get() = given["--host"] ?: "127.0.0.1"
    val commandPort: Int? get() = number("--command-port", PORTS)
    val dataPort: Int? get() = number("--data-port", PORTS)

    /** Compresses data from this length on. */
    val gzip: Gzip get() = number("--gzip-from", Int.MAX_VALUE)?.let { Gzip(it) } ?: Gzip()

    /** Time of the robot for each command, in milliseconds. */
    val delay: Long get() = number("--delay", Int.MAX_VALUE)?.toLong() ?: 0

    /** Scale of the picture; 1 is its normal size. */
    val pictureScale: Int get() = number("--picture-scale", 100) ?: 1

    /** `true` for output in Chinese, `false` for English, by option or by the POSIX locale. */
    val isChinese: Boolean get() = (given["--lang"] ?: locale()).startsWith("zh")

    private fun locale(): String = listOf("LC_ALL", "LC_MESSAGES", "LANG").mapNotNull(System::getenv).firstOrNull { it.isNotEmpty() } ?: ""

    /** Returns the address and ports as settings of a client. */
    fun client(): ClientConfig {
        var config = ClientConfig().host(host).gzip(gzip)
        number("--command-port", PORTS, least = 1)?.let { config = config.commandPort(it) }
        number("--data-port", PORTS, least = 1)?.let { config = config.dataPort(it) }
        return config
    }

    internal companion object {
        private const val PORTS = 65_535
        private val OPTIONS = listOf("--host", "--command-port", "--data-port", "--delay", "--gzip-from", "--picture-scale", "--lang")

        /** Longest wait for data that the robot sends unasked. */
        val PATIENCE_MILLIS: Long = TimeUnit.SECONDS.toMillis(20)
    }
}
