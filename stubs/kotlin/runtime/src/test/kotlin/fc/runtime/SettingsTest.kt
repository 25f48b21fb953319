package fc.runtime

import java.lang.reflect.InvocationTargetException
import java.lang.reflect.Method
import java.lang.reflect.Modifier
import java.util.concurrent.TimeUnit
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.launch

/** Returns the message of the `IllegalArgumentException`, or `null` if there is none. */
private inline fun refused(body: () -> Unit): String? = try {
    body()
    null
} catch (error: InvocationTargetException) {
    (error.targetException as? IllegalArgumentException ?: throw error.targetException).message
} catch (error: IllegalArgumentException) {
    error.message
}

/** A setter, with wrong and right values. */
private class Setting(val method: Method, val name: String, val wrong: List<Array<Any>>, val right: List<Array<Any>>)

private fun pairs(times: List<Long>, units: List<TimeUnit>): List<Array<Any>> = times.flatMap { time -> units.map { arrayOf(time, it) } }

private val LEAST_ONE = setOf(
    "connectionsPerAddress", "memory", "frameBytes", "inflatedBytes", "jsonDepth", "inFlight", "connections", "inflateRatio",
    "jsonValues", "jsonListBytes",
)

/** Every public method that takes a number, a time, a name or an address. A new one without a check fails the test. */
private fun settings(type: Class<*>): List<Setting> = type.methods
    .filter { Modifier.isPublic(it.modifiers) && it.returnType == type && it.parameterTypes.isNotEmpty() }
    .mapNotNull { method ->
        val name = "${type.simpleName}.${method.name}"
        val (first, isTime) = method.parameterTypes[0] to (method.parameterTypes.size == 2)
        val isPort = method.name.endsWith("Port")
        val least = if (method.name in LEAST_ONE || isPort && type == ClientConfig::class.java) 1 else 0
        when {
            first == Long::class.java && isTime -> {
                val right = pairs(listOf(0, 1, Long.MAX_VALUE), TimeUnit.values().toList())
                Setting(method, name, pairs(listOf(-1, Long.MIN_VALUE), TimeUnit.values().toList()), right)
            }
            first == Int::class.java -> {
                val wrong = listOf(least - 1, -1, Int.MIN_VALUE) + if (isPort) listOf(65_536, 99_999, Int.MAX_VALUE) else emptyList()
                Setting(method, name, wrong.map { arrayOf(it) }, listOf(least, 5, 65_535).map { arrayOf(it) })
            }
            first == Long::class.java ->
                Setting(method, name, listOf(least - 1L, -1L, Long.MIN_VALUE).map { arrayOf(it) }, listOf(least.toLong(), 5L).map { arrayOf(it) })
            first == String::class.java && !isTime ->
                Setting(method, name, listOf("", " ", "\t\n", "a\u0000b").map { arrayOf(it) }, listOf("::1", "robot").map { arrayOf(it) })
            else -> null
        }
    }

/** Wrong settings, call options, codes and ids are refused by the call that sets them. */
internal fun settingsTests(tests: Tests) {
    val right = listOf(Backoff(), ClientConfig(), ServerConfig(), CallOptions(), Toy.defaults.limits)
    for (one in right) {
        for (setting in settings(one.javaClass)) {
            tests.case("${setting.name} refuses wrong values by name") {
                for (values in setting.wrong) {
                    val said = refused { setting.method.invoke(one, *values) }
                    expect(true, said?.startsWith("`${setting.name}` is ")) { "${values.toList()}: $said:" }
                }
                for (values in setting.right) setting.method.invoke(one, *values)
            }
        }
    }
    tests.case("a port that does not exist is named with what is expected") {
        val said = refused { ClientConfig().commandPort(99_999) }
        expect("`ClientConfig.commandPort` is 99999, expected an integer from 1 to 65535", said)
        expect("`CallOptions.timeout` is -5 seconds, expected a time from 0", refused { CallOptions().timeout(-5, TimeUnit.SECONDS) })
    }
    tests.case("short times are not none, and long ones have no end") {
        expect(1L, CallOptions().timeout(1, TimeUnit.NANOSECONDS).timeout)
        expect(0L, CallOptions().timeout(0, TimeUnit.SECONDS).timeout)
        val longest = CallOptions().timeout(Long.MAX_VALUE, TimeUnit.DAYS).timeout ?: 0
        expect(true, after(1L shl 40, longest) > 1L shl 50)
        expect(longest, RateWatch(Int.MAX_VALUE, longest).deadline)
        expect(true, FrameWatch(longest).deadline(1 shl 30, 5) > 1L shl 50)
    }
    tests.case("settings of a protocol") {
        for ((name, make) in listOf<Pair<String, () -> Any>>(
            "AckPolicy.timeout" to { AckPolicy(-1, 0) },
            "AckPolicy.timeout" to { AckPolicy(Long.MAX_VALUE, 0) },
            "AckPolicy.retries" to { AckPolicy(1, -1) },
            "Gzip.fromBytes" to { Gzip(-1) },
            "Gzip.level" to { Gzip(0, 0) },
            "Gzip.level" to { Gzip(0, 10) },
            "Limits.jsonDepth" to { Limits(1, 1, 0, 1, 1, 1) },
            "Limits.queuedReports" to { Limits(1, 1, 1, 1, -1, 1) },
            "Defaults.callTimeout" to { Defaults(-1, 1, AckPolicy(1, 1), Toy.defaults.limits) },
            "Defaults.handlerTimeout" to { Defaults(1, -1, AckPolicy(1, 1), Toy.defaults.limits) },
            "Defaults.maxAge" to { Defaults(1, 1, AckPolicy(1, 1), Toy.defaults.limits, -1) },
            "first" to { Service().onRange(-1, 5) { _, _ -> Json.NULL } },
            "last" to { Service().onRange(5, 4) { _, _ -> Json.NULL } },
        )) {
            val said = refused { make() }
            expect(true, said?.startsWith("`$name` is ")) { "$name: $said:" }
        }
    }
    tests.case("codes, ids and times that do not exist are not sent") {
        val loop = TestLoop()
        val wire = TestWire(loop)
        val never = object : Timer {
            override fun cancel() = Unit
        }
        val dial = Dial { done -> never.also { done(wire.link, null) } }
        val client = ClientCore(Toy, ClientConfig().firstId(0).reconnect(null), loop, dial)
        val app = Connection(client, Dial { _ -> never })
        client.begin(isFirstOnly = true)
        loop.settle()
        val core = ServerCore(Toy, ServerConfig().firstId(0), loop, Service(), CoroutineScope(Dispatchers.Unconfined))
        val server = Server(core, null, null)
        val said = ArrayList<String?>()
        fun run(body: suspend () -> Unit) {
            CoroutineScope(SupervisorJob() + Dispatchers.Unconfined).launch { said.add(runCatching { body() }.exceptionOrNull()?.message) }
            loop.settle()
        }
        for (code in listOf(-1, 1 shl 16)) {
            run { app.callRaw(code, "{}") }
            run { server.sendStream(Audience.ALL, code, 1, ByteArray(1)) }
            run { app.data().send(code, 1, ByteArray(1)) }
        }
        for (id in listOf(-1L, 1L shl 32)) run { server.sendStream(Audience.ALL, 1, id, ByteArray(1)) }
        run { server.shutdown(-1, TimeUnit.SECONDS) }
        expect(9, said.size)
        expect(true, said.all { it != null && Regex("`(code|id|grace)` is .*, expected .*").matches(it) }) { "$said:" }
        expect(listOf(0, 0), listOf(wire.frames().size, app.inFlight))
    }
}
