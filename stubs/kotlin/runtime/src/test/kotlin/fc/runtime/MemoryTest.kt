package fc.runtime

import java.io.BufferedReader
import java.io.File
import java.io.InputStreamReader
import java.net.InetAddress
import java.net.InetSocketAddress
import java.net.Socket
import java.util.Random
import java.util.concurrent.TimeUnit
import java.util.concurrent.TimeUnit.DAYS
import kotlin.system.exitProcess
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.channels.Channel
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking
import kotlinx.coroutines.withTimeout

private const val KIB = 1024
private const val MIB = 1024 * KIB

/** The code of a command with a list of strings. */
private const val LISTS = 400

/** Bytes that any connection may hold. */
private const val NEEDED = 128 * KIB

/** A robot on a clock of the test, with many apps. Requests with a text wait for their [gates]. */
private class CrowdedRobot(memory: Int, config: ServerConfig = ServerConfig(), reply: String = "") {
    val loop = TestLoop()
    val gates = ArrayList<CompletableDeferred<Unit>>()
    val scope = CoroutineScope(SupervisorJob() + Dispatchers.Unconfined)
    private val service = Service().on(Toy.ECHO) { _, request ->
        if (request.text.isNotEmpty()) CompletableDeferred<Unit>().also { gates.add(it) }.await()
        EchoReply.of(reply)
    }.on(Toy.GO) { _, _ ->
        CompletableDeferred<Unit>().also { gates.add(it) }.await()
        Done.of()
    }.on(Command("lists", LISTS, Effect.MOTION, OneValue.of("lists", Types.list(Types.STRING)), Done)) { _, _ ->
        CompletableDeferred<Unit>().also { gates.add(it) }.await()
        Done.of()
    }
    private val settings = config.memory(memory.toLong()).connectionsPerAddress(100).handlerTimeout(1, DAYS).firstId(0)
    private val core = ServerCore(Toy, settings, loop, service, scope)
    val server = Server(core, null, null)
    val evicted get() = server.counters.connectionsEvicted
    private var hosts = 0

    private fun address() = InetSocketAddress(InetAddress.getByAddress(byteArrayOf(10, 0, 0, (++hosts).toByte())), 9)

    fun app() = TestWire(loop).also { wire ->
        expect(true, core.serve(wire.link, address()))
        loop.settle()
    }

    fun dataApp() = TestWire(loop).also { wire ->
        expect(true, core.serveData(wire.link, address()))
        loop.settle()
    }

    /** Returns `true` if a modest app gets its response. */
    fun serves(wire: TestWire): Boolean {
        wire.send(FrameId(false, Toy.commandKind, 100, 1), "{\"text\":\"\"}")
        loop.settle()
        return wire.frames().size == 1
    }
}

/** Breaks a connection: its peer can neither read nor write. */
private fun TestWire.breaks() {
    link.close()
    link.lose()
}

private fun request(text: String, id: Long = 1, gzip: Gzip? = null): ByteArray =
    Encoder(Toy, 1L shl 30, gzip).prepare("{\"text\":\"$text\"}".toByteArray()).frame(FrameId(false, Toy.commandKind, 100, id))

private fun stream(length: Int, id: Long, gzip: Gzip? = null): ByteArray =
    Encoder(Toy, 1L shl 30, gzip).prepare(ByteArray(length)).frame(FrameId(false, Toy.streamKind, 5, id))

/** Limits of the bytes that apps make a robot hold. */
internal fun memoryTests(tests: Tests) {
    tests.case("unfinished frames: the connection that holds most is closed") {
        val robot = CrowdedRobot(8 * MIB)
        val modest = robot.app()
        val wires = List(30) { robot.app() }
        for ((index, wire) in wires.withIndex()) {
            wire.link.give(request("x".repeat(1_900_000)).copyOf(1_100_000 + index * 1000))
            robot.loop.settle()
            expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory} after $index:" }
            expect(true, robot.serves(modest))
        }
        expect(true, robot.evicted >= 25) { "${robot.evicted}:" }
        wires.forEach { it.link.lose() }
        robot.loop.settle()
        expect(true, robot.server.memory <= NEEDED) { "${robot.server.memory}:" }
    }
    tests.case("inflating frames of one app wait for its handlers, and all are answered") {
        val robot = CrowdedRobot(8 * MIB)
        val (modest, app) = robot.app() to robot.app()
        for (id in 1L..16L) app.link.give(request("x".repeat(999_000), id, Gzip(0, 9)))
        var answers = 0
        for (round in 1..16) {
            robot.loop.advance(1000)
            expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory}:" }
            expect(true, robot.gates.size <= answers + 2) { "${robot.gates.size} at work:" }
            expect(true, robot.serves(modest))
            robot.gates[round - 1].complete(Unit)
            robot.loop.advance(1000)
            answers += app.frames().size
        }
        expect(listOf<Any>(16, 0L), listOf(answers, robot.evicted))
        expect(true, robot.server.memory <= 2 * NEEDED) { "${robot.server.memory}:" }
    }
    tests.case("inflating frames of many apps") {
        val robot = CrowdedRobot(8 * MIB)
        val modest = robot.app()
        val apps = List(24) { robot.app() }
        for (app in apps) {
            app.link.give(request("x".repeat(999_000), 1, Gzip(0, 9)))
            robot.loop.settle()
            expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory}:" }
        }
        expect(true, robot.serves(modest))
        var at = 0
        while (at < robot.gates.size) {
            robot.gates[at++].complete(Unit)
            robot.loop.advance(1000)
            expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory}:" }
        }
        // The other apps have got their responses.
        expect(24, apps.sumOf { it.frames().size } + robot.evicted.toInt())
        expect(true, at >= 3) { "$at:" }
    }
    tests.case("a handler keeps what was lent to it, until it ends") {
        val robot = CrowdedRobot(8 * MIB)
        val (modest, app) = robot.app() to robot.app()
        val body = "{\"metres\":1,\"x\":\"${"x".repeat(999_000)}\"}".toByteArray()
        for (id in 1L..2L) app.link.give(TestWire.bytes(FrameId(false, Toy.commandKind, 200, id), body))
        robot.loop.settle()
        expect(listOf<Any>(2, true), listOf(robot.gates.size, robot.server.memory >= 3_996_000))
        app.breaks()
        robot.loop.settle()
        expect(listOf<Any>(2L, true), listOf(robot.server.counters.handlersAbandoned, robot.server.memory >= 3_996_000))
        expect(true, robot.serves(modest))
        // Another long request waits for the end of the first.
        val other = robot.app()
        other.link.give(request("x".repeat(999_000)))
        robot.loop.settle()
        expect(2, robot.gates.size)
        robot.gates[0].complete(Unit)
        robot.loop.settle()
        expect(3, robot.gates.size)
        robot.gates.forEach { it.complete(Unit) }
        robot.loop.settle()
        expect(listOf<Any>(1, true), listOf(other.frames().size, robot.server.memory <= 3 * NEEDED))
    }
    tests.case("short texts with long lists wait for handlers") {
        val robot = CrowdedRobot(MIB)
        val (modest, app) = robot.app() to robot.app()
        val body = "{\"value\":[${"\"\",".repeat(1000)}\"\"]}".toByteArray()
        for (id in 1L..60L) app.link.give(TestWire.bytes(FrameId(false, Toy.commandKind, LISTS, id), body))
        var answers = 0
        while (answers < 60) {
            robot.loop.settle()
            expect(true, robot.server.memory <= MIB) { "${robot.server.memory}:" }
            expect(true, robot.gates.size in answers + 1..answers + 14) { "${robot.gates.size} of $answers:" }
            robot.gates[answers++].complete(Unit)
        }
        robot.loop.settle()
        expect(listOf<Any>(60, 0L, true), listOf(app.frames().size, robot.evicted, robot.serves(modest)))
    }
    tests.case("a handler that is cancelled gives back what was lent to it") {
        val robot = CrowdedRobot(8 * MIB)
        val app = robot.app()
        for (id in 1L..2L) app.link.give(request("x".repeat(999_000), id))
        robot.loop.settle()
        expect(listOf<Any>(2, true), listOf(robot.gates.size, robot.server.memory >= 3_996_000))
        app.breaks()
        robot.loop.settle()
        expect(0L, robot.server.memory)
    }
    tests.case("an app that does not read is not read") {
        val reply = "y".repeat(10_000)
        val robot = CrowdedRobot(8 * MIB, reply = reply)
        val app = robot.app()
        app.link.room = 0
        for (id in 1L..2000L) app.link.give(request("", id))
        robot.loop.settle()
        expect(true, robot.server.memory < MIB) { "${robot.server.memory}:" }
        expect(true, robot.server.counters.callsSucceeded < 100)
        app.link.room = Int.MAX_VALUE
        robot.loop.settle()
        expect(listOf<Any>(2000, 0L), listOf(app.frames().size, robot.evicted))
    }
    tests.case("many long responses that an app does not read") {
        val robot = CrowdedRobot(8 * MIB, reply = "y".repeat(MIB))
        val (modest, greedy) = robot.app() to robot.app()
        greedy.link.room = 0
        for (id in 1L..60L) greedy.link.give(request("x", id))
        robot.loop.settle()
        for (gate in robot.gates.toList()) {
            gate.complete(Unit)
            robot.loop.settle()
            expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory}:" }
        }
        expect(listOf<Any>(true, 1L, true), listOf(greedy.link.isClosed, robot.evicted, robot.serves(modest)))
    }
    tests.case("reports that wait close no connection") {
        val robot = CrowdedRobot(8 * MIB, ServerConfig().limits(Toy.defaults.limits.inFlight(1)))
        val apps = List(3) { robot.app() }
        val ended = ArrayList<AckOutcome>()
        val long = Moved.make(arrayOf(1), Extra.NONE.plus("x", Json.of("\"${"y".repeat(MIB)}\"")))
        repeat(10) { robot.scope.launch { robot.server.push(Audience.ALL, Toy.MOVED, long).forEach { ended.add(it.outcome) } } }
        for (app in apps) app.link.room = 0
        robot.loop.settle()
        expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory}:" }
        expect(listOf<Any>(0L, false), listOf(robot.evicted, apps.any { it.link.isClosed }))
        apps.forEach { it.link.lose() }
        robot.loop.settle()
        expect(setOf(AckOutcome.DROPPED, AckOutcome.CLOSED), ended.toSet())
        expect(listOf<Any>(30, 0L), listOf(ended.size, robot.server.memory))
    }
    streamMemoryTests(tests)
    tests.case("many unknown keys take no more than their text") {
        val keys = "\"a\":1,".repeat(100_000)
        val read = Bodies.enveloped(ToyRequest, Echo, "{$keys\"text\":\"\"}".toByteArray(), Toy.defaults.limits.json()).body!!
        expect(listOf<Any?>(100_000, "1", null), listOf(read.extra.size, read.extra["a"]?.text, read.extra["b"]))
        expect("{\"text\":\"\",${keys.dropLast(1)}}", read.toJson().text)
    }
    tests.case("a robot in a small heap survives what apps send") { runBlocking { smallHeap() } }
}

private fun streamMemoryTests(tests: Tests) {
    tests.case("frames of streams that wait for the robot are few") {
        val robot = CrowdedRobot(32 * MIB)
        val streams = robot.server.streams()
        val apps = List(20) { index -> robot.dataApp().also { it.link.give(stream(MIB, index.toLong())) } }
        robot.loop.settle()
        expect(4L, robot.server.counters.streamFramesIn)
        val ids = HashSet<Long>()
        robot.scope.launch { while (true) ids.add((streams.receive() ?: break).frame.id) }
        repeat(50) { robot.loop.settle() }
        expect(listOf<Any>(20, 0L, false), listOf(ids.size, robot.evicted, apps.any { it.link.isClosed }))
    }
    tests.case("one long frame of a stream fills the queue") {
        val robot = CrowdedRobot(64 * MIB, ServerConfig().queuedBytes(MIB.toLong()))
        robot.server.streams()
        val app = robot.dataApp()
        for (id in 1L..3L) app.link.give(stream(MIB, id))
        robot.loop.settle()
        expect(1L, robot.server.counters.streamFramesIn)
    }
    tests.case("frames of streams count, and go with their connection") {
        val robot = CrowdedRobot(16 * MIB)
        val streams = robot.server.streams()
        val (modest, bomb) = robot.dataApp() to robot.dataApp()
        modest.link.give(stream(6, 1))
        for (id in 2L..4L) bomb.link.give(stream(4 * MIB, id, Gzip(0, 9)))
        repeat(3) { robot.loop.advance(1000) }
        expect(4L, robot.server.counters.streamFramesIn)
        // The next frame needs more than the free memory.
        val other = robot.app()
        other.link.give(request("x".repeat(4_000_000)).copyOf(3_900_000))
        robot.loop.settle()
        expect(listOf<Any>(1L, true, false), listOf(robot.evicted, bomb.link.isClosed, other.link.isClosed))
        val ids = ArrayList<Long>()
        robot.scope.launch { while (true) ids.add((streams.receive() ?: break).frame.id) }
        robot.loop.settle()
        expect(listOf(1L), ids)
    }
    tests.case("frames of streams that an app does not read") {
        val robot = CrowdedRobot(8 * MIB)
        val apps = List(10) { robot.dataApp().also { it.link.room = 0 } }
        val taken = ArrayList<Int>()
        repeat(5) { robot.scope.launch { taken.add(robot.server.sendStream(Audience.ALL, 5, 1, ByteArray(MIB))) } }
        robot.loop.settle()
        expect(true, robot.server.memory <= 8 * MIB) { "${robot.server.memory}:" }
        expect(0L, robot.evicted)
        for (app in apps) app.link.room = Int.MAX_VALUE
        robot.loop.settle()
        expect(List(5) { 10 }, taken)
    }
}

/** Decompresses frames from many connections, at a robot without memory for them. */
private suspend fun smallHeap() {
    val java = File(System.getProperty("java.home"), "bin/java").path
    val program = ProcessBuilder(java, "-Xmx96m", "-cp", System.getProperty("java.class.path"), "fc.runtime.SmallHeap")
        .redirectError(ProcessBuilder.Redirect.INHERIT).start()
    try {
        val said = BufferedReader(InputStreamReader(program.inputStream))
        val port = said.readLine().toInt()
        val bodies = listOf("\"y\":\"${"z".repeat(5_900_000)}\"", "\"a\":1,".repeat(950_000) + "\"b\":1", "\"b\":[${"1,".repeat(900_000)}1]")
        // Text that hardly compresses: a large ratio is refused at once.
        val noise = hex(ByteArray(40_000).also { Random(1).nextBytes(it) })
        val frames = bodies.mapIndexed { id, keys ->
            val body = "{\"text\":\"hold\",\"noise\":\"$noise\",$keys}".toByteArray()
            Encoder(Toy, 1L shl 30, Gzip(0, 9)).prepare(body).frame(FrameId(false, Toy.commandKind, 100, id.toLong()))
        }
        val sockets = List(12) { Socket("127.0.0.1", port) }
        val senders = sockets.mapIndexed { index, socket ->
            // The robot closes some connections, and does not read others to the end.
            kotlin.concurrent.thread(isDaemon = true) { runCatching { repeat(4) { socket.getOutputStream().write(frames[index % 3]) } } }
        }
        withTimeout(30_000) {
            val app = Connection.connect(Toy, ClientConfig().host("127.0.0.1").commandPort(port))
            repeat(200) { expect("echo", app.call(Toy.ECHO, Echo.of("echo"), CallOptions().timeout(20, TimeUnit.SECONDS)).text) }
            app.close()
        }
        sockets.forEach { it.close() }
        senders.forEach { it.join() }
        program.outputStream.close()
        expect("healthy", said.readLine())
        expect(0, program.waitFor())
    } finally {
        program.destroy()
    }
}

/** The robot of [smallHeap], until its input ends. */
internal object SmallHeap {
    @JvmStatic
    fun main(arguments: Array<String>) {
        val lines = ArrayList<String>()
        val held = Channel<CompletableDeferred<Unit>>(Channel.UNLIMITED)
        val service = Service().on(Toy.ECHO) { _, request ->
            // Each echo ends the oldest waiting handler.
            if (request.text == "echo") held.tryReceive().getOrNull()?.complete(Unit)
            if (request.text == "hold") CompletableDeferred<Unit>().also { held.send(it) }.await()
            EchoReply.of(request.text)
        }
        val config = ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0).memory(24L * MIB).connectionsPerAddress(50)
            .handlerTimeout(1, DAYS).log { level, line -> if (level == LogLevel.ERROR) lines.add(line) }
        val server = Server.bind(Toy, service, config)
        println(server.commandAddress.port)
        while (System.`in`.read() >= 0) continue
        runBlocking { server.shutdown(1, TimeUnit.SECONDS) }
        println(if (lines.isEmpty()) "healthy" else "$lines")
        exitProcess(0)
    }
}
