package fc.runtime

import java.util.concurrent.TimeUnit.DAYS
import java.util.concurrent.TimeUnit.MILLISECONDS
import java.util.concurrent.TimeUnit.SECONDS
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.launch

/** A robot with an app at its other end, and a clock of the test. Its motions wait for [gates]. */
private class LimitedRobot(config: ServerConfig) {
    val loop = TestLoop()
    val wire = TestWire(loop)
    val gates = ArrayList<CompletableDeferred<Unit>>()
    private val scope = CoroutineScope(SupervisorJob() + Dispatchers.Unconfined)
    private val service = Service().on(Toy.GO) { _, _ ->
        CompletableDeferred<Unit>().also { gates.add(it) }.await()
        Done.of()
    }
    private val core = ServerCore(Toy, config.firstId(0), loop, service, scope)
    private val server = Server(core, null, null)
    val ended = ArrayList<String>()
    val counters get() = server.counters

    init {
        core.serve(wire.link, null)
        loop.settle()
    }

    fun go(id: Long) = wire.send(FrameId(false, Toy.commandKind, 200, id), "{\"metres\":1}").also { loop.settle() }

    fun report(metres: Int) {
        scope.launch { ended.add("$metres ${server.push(Audience.ALL, Toy.MOVED, Moved.of(metres))[0].outcome}") }
        loop.settle()
    }
}

/** An app with a robot at its other end. */
private class LimitedApp(config: ClientConfig) {
    val loop = TestLoop()
    var wire = TestWire(loop)
    private val core = ClientCore(
        Toy,
        config.firstId(0).reconnect(null),
        loop,
        Dial { done ->
            done(wire.link, null)
            object : Timer {
                override fun cancel() = Unit
            }
        },
    )
    val app = Connection(core, Dial { _ -> throw Wrong("no data here") })

    init {
        core.begin(isFirstOnly = true)
        loop.settle()
    }

    /** Sends a report. Returns `true` if it is acknowledged. */
    fun report(id: Long, body: String = "{\"metres\":1}", code: Int = 300): Boolean {
        wire.send(FrameId(false, Toy.reportKind, code, id), body)
        loop.settle()
        return wire.frames().any { it.id.isResponse && it.id.id == id }
    }
}

/** Limits just below, at and above, with the log lines of each. */
internal fun limitTests(tests: Tests) {
    val limits = Toy.defaults.limits
    tests.case("what is ready at the same time goes out with one write") {
        val robot = LimitedRobot(ServerConfig())
        for (id in 1L..9L) robot.go(id)
        fun answer(gates: IntRange) {
            for (gate in gates) robot.gates[gate].complete(Unit)
            robot.loop.settle()
        }
        answer(0..2)
        expect(1, robot.wire.link.writes)
        expect(listOf(1L, 2L, 3L), robot.wire.frames().map { it.id.id })
        // The app takes a part of these responses, and the rest later with the next ones.
        robot.wire.link.room = 100
        answer(3..5)
        answer(6..8)
        robot.wire.link.room = Int.MAX_VALUE
        robot.loop.settle()
        expect((4L..9L).toList(), robot.wire.frames().map { it.id.id })
        expect(3, robot.wire.link.writes)
    }
    tests.case("in flight at the robot") {
        val robot = LimitedRobot(ServerConfig().limits(limits.inFlight(2)))
        for (id in 1L..3L) robot.go(id)
        expect(2, robot.gates.size)
        robot.gates[0].complete(Unit)
        robot.loop.settle()
        expect(3, robot.gates.size)
    }
    tests.case("calls have one counter for each result") {
        val robot = LimitedRobot(ServerConfig().limits(limits.inFlight(2)).handlerTimeout(1000, MILLISECONDS).maxAge(60, SECONDS))
        fun command(code: Int, body: String) = robot.wire.send(FrameId(false, Toy.commandKind, code, 1), body).also { robot.loop.settle() }
        robot.go(1)
        robot.gates[0].complete(Unit)
        robot.go(2)
        robot.gates[1].completeExceptionally(Refusal(7, "no"))
        command(999, "{}")
        command(100, "{\"text\":\"a\"}")
        command(200, "{}")
        command(200, "{\"time\":1,\"metres\":1}")
        for (id in 3L..4L) robot.go(id)
        robot.loop.advance(1000)
        val counters = robot.counters
        val byResult = counters.run { listOf(callsSucceeded, callsRefused, callsProtocol, callsInvalid, callsExpired, callsTimedOut) }
        expect(listOf(1L, 1L, 2L, 1L, 1L, 2L), byResult)
        expect(listOf(1L, 2L, 1L), counters.run { listOf(callsNotImplemented, handlersAbandoned, inFlightReached) })
    }
    tests.case("sent and repeated reports have counters") {
        val robot = LimitedRobot(ServerConfig())
        robot.report(1)
        robot.loop.advance(Toy.defaults.ack.timeout + Toy.defaults.ack.timeout / 8)
        expect(listOf(1L, 1L), robot.counters.run { listOf(reportsSent, reportsRepeated) })
    }
    tests.case("reports queued at the robot: the oldest gives way") {
        val robot = LimitedRobot(ServerConfig().limits(limits.inFlight(1).queuedReports(2)))
        for (metres in 1..5) robot.report(metres)
        expect(listOf("2 DROPPED", "3 DROPPED"), robot.ended)
        expect(2L, robot.counters.reportsDropped)
    }
    tests.case("bytes of reports queued at the robot") {
        val size = Encoder(Toy, 1L shl 24, null).prepare(Bodies.write(Envelopes.request(Toy, 1_700_000_000_000), Moved.of(1))).length
        val robot = LimitedRobot(ServerConfig().limits(limits.inFlight(1)).queuedBytes(2L * size))
        for (metres in 1..3) robot.report(metres)
        expect(listOf("2 DROPPED"), robot.ended)
        robot.wire.send(robot.wire.frames()[0].id.answer(), "{\"result\":0}")
        robot.loop.settle()
        robot.report(4)
        expect(listOf("2 DROPPED", "1 ACKNOWLEDGED"), robot.ended)
    }
    tests.case("reports and bytes queued at the app") {
        val app = LimitedApp(ClientConfig().limits(limits.queuedReports(2)).queuedBytes(40))
        val reports = app.app.reports()
        expect(listOf(true, true, false), (1L..3L).map { app.report(it) })
        expect(1L, app.app.counters.reportsRefused)
        repeat(2) { expect(true, reports.poll() != null) }
        expect(listOf(true, false), listOf(app.report(3, "{\"metres\":1,\"x\":\"${"y".repeat(15)}\"}"), app.report(4)))
    }
    tests.case("what one receiver misses another takes") {
        val app = LimitedApp(ClientConfig().limits(limits.queuedReports(1)))
        val (quick, slow) = app.app.reports() to app.app.reports()
        for (id in 1L..3L) {
            expect(true, app.report(id))
            expect(id, quick.poll()?.id)
        }
        expect(listOf(0L, 2L, 0L), listOf(quick.missed(), slow.missed(), slow.missed()))
        expect(listOf<Any?>(1L, null), listOf(slow.poll()?.id, slow.poll()))
    }
    tests.case("a report that cannot be read is refused") {
        val app = LimitedApp(ClientConfig())
        app.app.reports()
        app.wire.send(FrameId(false, Toy.reportKind, 300, 1), "{\"metres\":\"far\"}")
        app.loop.settle()
        expect(listOf(3), app.wire.frames().map { Tree.of(String(it.body))["result"].int })
        expect(1L, app.app.counters.reportsInvalid)
    }
    tests.case("reports that come late") {
        val app = LimitedApp(ClientConfig())
        app.app.reports()
        for ((id, wait) in listOf(1L to 0L, 2L to 1500L, 3L to 1501L)) {
            app.loop.advance(wait)
            app.report(id, "{}", 301)
        }
        expect(1L, app.app.counters.reportsLate)
    }
    tests.case("a connection that is idle, and one that is not") {
        val robot = LimitedRobot(ServerConfig().idleTimeout(1000, MILLISECONDS).handlerTimeout(1, DAYS))
        robot.loop.advance(999)
        robot.go(1)
        robot.loop.advance(5000)
        expect(false, robot.wire.link.hasGone)
        robot.gates[0].complete(Unit)
        robot.loop.advance(1000)
        expect(true, robot.wire.link.hasGone)
    }
    tests.case("a byte now and then is no progress") {
        val robot = LimitedRobot(ServerConfig().stallTimeout(10, SECONDS))
        val frame = TestWire.bytes(FrameId(false, 1, 200, 1), ByteArray(500_000))
        robot.wire.link.give(frame.copyOf(100))
        for (at in 100 until 109) {
            robot.loop.settle()
            robot.wire.link.give(frame.copyOfRange(at, at + 1))
            robot.loop.advance(999)
        }
        expect(false, robot.wire.link.hasGone)
        robot.loop.advance(1010)
        expect(true, robot.wire.link.hasGone)
        expect(1L, robot.counters.connectionsTimedOut)
    }
    tests.case("fast enough is progress") {
        val robot = LimitedRobot(ServerConfig().stallTimeout(10, SECONDS))
        val frame = TestWire.bytes(FrameId(false, 1, 200, 1), ByteArray(500_000))
        for (second in 0 until 30) {
            robot.wire.link.give(frame.copyOfRange(second * 1100, second * 1100 + 1100))
            robot.loop.advance(1000)
        }
        expect(false, robot.wire.link.hasGone)
    }
    tests.case("an app that does not read") {
        val robot = LimitedRobot(ServerConfig().stallTimeout(10, SECONDS))
        robot.wire.link.room = 0
        robot.wire.send(FrameId(false, Toy.commandKind, 999, 1), "{}")
        robot.loop.settle()
        robot.loop.advance(9999)
        expect(false, robot.wire.link.hasGone)
        robot.loop.advance(1)
        expect(true, robot.wire.link.isClosed)
    }
    tests.case("a robot whose frame swallows answers") {
        val app = LimitedApp(ClientConfig().stallTimeout(10, SECONDS))
        val frame = TestWire.bytes(FrameId(false, 3, 300, 1), ByteArray(5_000_000))
        // Steady progress below the least rate: 16 KiB a second after the ten seconds.
        for (second in 0 until 10) {
            app.wire.link.give(frame.copyOfRange(second * 1000, second * 1000 + 1000))
            app.loop.settle()
            app.loop.advance(1000)
        }
        expect(true, app.app.state.isConnected)
        app.loop.advance(1000)
        expect("stalled", app.app.state.why?.name)
    }
    tests.case("a robot that does not read") {
        val app = LimitedApp(ClientConfig().stallTimeout(10, SECONDS).callTimeout(1, DAYS))
        app.wire.link.room = 0
        CoroutineScope(Dispatchers.Unconfined).launch { runCatching { app.app.call(Toy.GO, Go.of(1)) } }
        app.loop.settle()
        app.loop.advance(9999)
        expect(true, app.app.state.isConnected)
        app.loop.advance(1)
        expect("unread", app.app.state.why?.name)
    }
    paceTests(tests)
}

/** The cost of useless work, the allowed networks, and their log lines. */
private fun paceTests(tests: Tests) {
    tests.case("frames that cannot be used, up to those that are free") {
        val robot = LimitedRobot(ServerConfig())
        for (id in 1L..256L) robot.wire.send(FrameId(false, Toy.commandKind, 999, id), "{}")
        robot.loop.settle()
        robot.go(1000)
        expect(listOf<Any>(1, 0L), listOf<Any>(robot.gates.size, robot.counters.connectionsPaced))
    }
    tests.case("frames that cannot be used, and one more than is free") {
        val robot = LimitedRobot(ServerConfig())
        for (id in 1L..257L) robot.wire.send(FrameId(false, Toy.commandKind, 999, id), "{}")
        robot.loop.settle()
        robot.go(1000)
        expect(listOf<Any>(0, 1L), listOf<Any>(robot.gates.size, robot.counters.connectionsPaced))
        robot.loop.advance(1)
        expect(1, robot.gates.size)
    }
    tests.case("bytes that are decompressed") {
        val robot = LimitedRobot(ServerConfig())
        val id = FrameId(false, Toy.commandKind, 999, 1)
        robot.wire.link.give(Encoder(Toy, 1L shl 24, Gzip(0, 9)).prepare("{\"x\":\"${"y".repeat(1_000_000)}\"}".toByteArray()).frame(id))
        robot.loop.settle()
        robot.go(2)
        expect(listOf<Any>(0, 1L), listOf<Any>(robot.gates.size, robot.counters.connectionsPaced))
        robot.loop.advance(8)
        expect(1, robot.gates.size)
    }
    tests.case("networks") {
        fun has(network: String, address: String) = Network.of(network).has(java.net.InetAddress.getByName(address))
        for ((network, address, isIn) in listOf(
            Triple("10.0.0.0/24", "10.0.0.255", true),
            Triple("10.0.0.0/24", "10.0.1.0", false),
            Triple("10.0.0.128/25", "10.0.0.127", false),
            Triple("10.0.0.7", "10.0.0.7", true),
            Triple("0.0.0.0/0", "200.1.2.3", true),
            Triple("0.0.0.0/0", "::1", false),
            Triple("fd00::/8", "fdff::1", true),
            Triple("::ffff:10.0.0.0/104", "10.9.9.9", true),
        )) expect(isIn, has(network, address)) { "$network $address:" }
        for (wrong in listOf("10.0.0.1/24", "10.0.0.0/33", "robot/8", "10.0.0.0/", "", "10.0.0.0/-1", "10.0.0.0/+8", "::/129")) {
            expect(true, runCatching { Network.of(wrong) }.exceptionOrNull() is IllegalArgumentException) { "$wrong:" }
        }
    }
    tests.case("the smallest network counts") {
        val allowed = Allowed.EVERYBODY.plus(Network.of("10.0.0.0/8"), setOf(Effect.READ)).plus(Network.of("10.0.7.0/24"), Allowed.ALL)
        fun of(address: String) = allowed.effects(java.net.InetAddress.getByName(address))
        expect(listOf(setOf(Effect.READ), Allowed.ALL, null), listOf(of("10.1.1.1"), of("10.0.7.1"), of("11.0.0.1")))
    }
    tests.case("the log says what happens, and holds back what comes too often") {
        val said = ArrayList<String>()
        val app = LimitedApp(ClientConfig().host("robot").log { level, line -> said.add("$level $line") })
        app.app.close()
        app.loop.settle()
        expect(listOf("INFO connected to robot", "INFO the connection to robot has ended: the connection was closed by this side"), said)
        val lines = ArrayList<String>()
        var now = 0L
        val thin = Lines({ _, line -> lines.add(line) }, Toy) { now }
        repeat(7) { thin.say(LogLevel.INFO, "one") { "one" } }
        thin.say(LogLevel.INFO, "two") { "two" }
        now = 60_000
        thin.say(LogLevel.INFO, "one") { "one" }
        expect(List(5) { "one" } + listOf("two", "one (2 more like it were left out)"), lines)
    }
    tests.case("the log of a robot") {
        val said = ArrayList<String>()
        val robot = LimitedRobot(ServerConfig().log { level, line -> said.add("$level $line") })
        robot.wire.link.lose()
        robot.loop.settle()
        expect(listOf("INFO connected: 1 from null", "INFO ended: 1"), said)
    }
}
