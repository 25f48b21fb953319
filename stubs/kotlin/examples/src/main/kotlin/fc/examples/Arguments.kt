package fc.examples

import fc.runtime.ClientConfig
import fc.runtime.Gzip
import java.util.concurrent.TimeUnit
import kotlin.system.exitProcess

/** What the programs are told: the host, both ports, and what makes trials harder. */
internal class Arguments(arguments: Array<String>, usage: String) {
    private val given = HashMap<String, String>()

    init {
        val words = arguments.iterator()
        while (words.hasNext()) {
            val word = words.next()
            if (word !in OPTIONS || !words.hasNext()) {
                val isAsked = word == "--help"
                (if (isAsked) System.out else System.err).println(usage)
                exitProcess(if (isAsked) 0 else 2)
            }
            given[word] = words.next()
        }
    }

    val host: String get() = given["--host"] ?: "127.0.0.1"
    val commandPort: Int? get() = given["--command-port"]?.toInt()
    val dataPort: Int? get() = given["--data-port"]?.toInt()

    /** What is compressed: whatever has so many bytes. */
    val gzip: Gzip get() = given["--gzip-from"]?.let { Gzip(it.toInt()) } ?: Gzip()

    /** How long the robot takes over each command, in milliseconds. */
    val delay: Long get() = given["--delay"]?.toLong() ?: 0

    /** How many times as wide and high the robot's picture is. */
    val pictureScale: Int get() = given["--picture-scale"]?.toInt() ?: 1

    /** Whether they speak Chinese, or else English: as they are told, or as POSIX has it of the environment. */
    val isChinese: Boolean get() = (given["--lang"] ?: locale()).startsWith("zh")

    private fun locale(): String = listOf("LC_ALL", "LC_MESSAGES", "LANG").mapNotNull(System::getenv).firstOrNull { it.isNotEmpty() } ?: ""

    /** The robot and the ports as settings of a client. */
    fun client(): ClientConfig {
        var config = ClientConfig().host(host).gzip(gzip)
        commandPort?.let { config = config.commandPort(it) }
        dataPort?.let { config = config.dataPort(it) }
        return config
    }

    internal companion object {
        private val OPTIONS = listOf("--host", "--command-port", "--data-port", "--delay", "--gzip-from", "--picture-scale", "--lang")

        /** How long the programs wait for what is to come by itself. */
        val PATIENCE_MILLIS: Long = TimeUnit.SECONDS.toMillis(20)
    }
}
