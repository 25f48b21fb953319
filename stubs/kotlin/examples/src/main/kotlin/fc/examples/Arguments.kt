package fc.examples

import fc.runtime.ClientConfig
import fc.runtime.Gzip
import java.util.concurrent.TimeUnit
import kotlin.system.exitProcess

/** What the programs are told: the host, both ports, and what makes trials harder. */
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

    /** The number of an option. */
    private fun number(option: String, most: Int, least: Int = 0): Int? {
        val given = given[option] ?: return null
        return given.toIntOrNull()?.takeIf { it in least..most }
            ?: refuse("`$option` is $given, expected an integer from $least to $most")
    }

    val host: String get() = given["--host"] ?: "127.0.0.1"
    val commandPort: Int? get() = number("--command-port", PORTS)
    val dataPort: Int? get() = number("--data-port", PORTS)

    /** What is compressed: whatever has so many bytes. */
    val gzip: Gzip get() = number("--gzip-from", Int.MAX_VALUE)?.let { Gzip(it) } ?: Gzip()

    /** How long the robot takes over each command, in milliseconds. */
    val delay: Long get() = number("--delay", Int.MAX_VALUE)?.toLong() ?: 0

    /** How many times as wide and high the robot's picture is. */
    val pictureScale: Int get() = number("--picture-scale", 100) ?: 1

    /** Whether they speak Chinese, or else English: as they are told, or as POSIX has it of the environment. */
    val isChinese: Boolean get() = (given["--lang"] ?: locale()).startsWith("zh")

    private fun locale(): String = listOf("LC_ALL", "LC_MESSAGES", "LANG").mapNotNull(System::getenv).firstOrNull { it.isNotEmpty() } ?: ""

    /** The robot and the ports as settings of a client. */
    fun client(): ClientConfig {
        var config = ClientConfig().host(host).gzip(gzip)
        number("--command-port", PORTS, least = 1)?.let { config = config.commandPort(it) }
        number("--data-port", PORTS, least = 1)?.let { config = config.dataPort(it) }
        return config
    }

    internal companion object {
        private const val PORTS = 65_535
        private val OPTIONS = listOf("--host", "--command-port", "--data-port", "--delay", "--gzip-from", "--picture-scale", "--lang")

        /** How long the programs wait for what is to come by itself. */
        val PATIENCE_MILLIS: Long = TimeUnit.SECONDS.toMillis(20)
    }
}
