package fc.runtime

import java.io.DataInputStream
import java.net.InetSocketAddress
import java.net.ServerSocket
import java.net.Socket
import java.util.concurrent.TimeUnit.MILLISECONDS
import java.util.concurrent.TimeUnit.SECONDS
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.async
import kotlinx.coroutines.awaitAll
import kotlinx.coroutines.cancelAndJoin
import kotlinx.coroutines.flow.first
import kotlinx.coroutines.flow.toList
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking
import kotlinx.coroutines.withTimeout

internal const val LOCAL = "127.0.0.1"

/** A robot that echoes. Its motions wait for [gate]. */
internal class TestRobot(config: ServerConfig = ServerConfig(), val gate: CompletableDeferred<Unit>? = null) {
    val begun = CompletableDeferred<Context>()
    val ended = CompletableDeferred<Unit>()
    val cancelled = CompletableDeferred<Unit>()
    val server = Server.bind(
        Toy,
        Service()
            .on(Toy.ECHO) { _, request ->
                if (request.text == "fail") throw NotImplementedError("secret")
                if (request.text == "refuse") throw Refusal(7, "no")
                EchoReply.of(request.text)
            }
            .on(Toy.GO) { context, _ ->
                begun.complete(context)
                try {
                    gate?.await()
                } catch (failure: kotlinx.coroutines.CancellationException) {
                    cancelled.complete(Unit)
                    throw failure
                }
                ended.complete(Unit)
                Done.of()
            },
        config.address(LOCAL).commandPort(0).dataPort(0).log(config.log ?: Log { _, _ -> }),
    )

    fun config(): ClientConfig =
        ClientConfig().host(LOCAL).commandPort(server.commandAddress.port).dataPort(server.dataAddress.port)
            .reconnect(Backoff().first(1, MILLISECONDS).longest(5, MILLISECONDS))

    suspend fun app(): Connection = Connection.connect(Toy, config())
}

internal fun Tests.net(name: String, body: suspend () -> Unit) = case(name) { runBlocking { withTimeout(20_000) { body() } } }

private suspend fun callError(body: suspend () -> Unit): String? = try {
    body()
    null
} catch (error: CallError) {
    error.name
}

/** Tests over real sockets. */
internal fun netTests(tests: Tests) {
    tests.net("calls, refusals and failures") {
        val robot = TestRobot()
        val app = robot.app()
        expect("hello", app.call(Toy.ECHO, Echo.of("hello")).text)
        val refused = runCatching { app.call(Toy.ECHO, Echo.of("refuse")) }.exceptionOrNull() as CallError
        expect(listOf("refused", 7L), listOf(refused.name, refused.refusal?.code))
        val failed = runCatching { app.call(Toy.ECHO, Echo.of("fail")) }.exceptionOrNull() as CallError
        expect(listOf("refused", "protocol: the handler failed"), listOf(failed.name, failed.refusal?.text))
        expect(1L, robot.server.counters.handlersPanicked)
        expect("invalid_request", callError { app.call(Toy.ECHO, Echo.of("x".repeat(1_000_001))) })
        expect("invalid_request", callError { app.callRaw(100, "[]") })
        // Java can pass messages of another type.
        @Suppress("UNCHECKED_CAST")
        val wrong = runCatching { app.call(Toy.ECHO as Command<Go, EchoReply>, Go.of(1)) }.exceptionOrNull() as CallError
        expect(listOf("invalid_request", "wrong_type"), listOf(wrong.name, (wrong.cause as BodyError).name))
        @Suppress("UNCHECKED_CAST")
        val report = runCatching { robot.server.push(Audience.ALL, Toy.MOVED as Report<Tick>, Tick.of()) }.exceptionOrNull() as PushError
        expect(listOf("invalid_report", "wrong_type"), listOf(report.name, (report.cause as BodyError).name))
        expect(1L, app.callRaw(9, "{}").resultCode)
        expect(true, app.callRaw(100, "{\"text\":\"raw\"}").json.contains("\"text\":\"raw\""))
        expect(robot.server.connections().size, 1)
        app.close()
        expect("closed_here", app.closed().name)
        expect("closed", callError { app.call(Toy.ECHO, Echo.of("late")) })
        robot.server.close()
    }
    tests.net("many calls at once, gzip both ways, large bodies") {
        val robot = TestRobot(ServerConfig().gzip(Gzip()))
        val app = Connection.connect(Toy, robot.config().gzip(Gzip()))
        val texts = (0 until 60).map { "$it ".repeat(1 + it * 500) }
        val answers = kotlinx.coroutines.coroutineScope {
            texts.map { text -> async(Dispatchers.Default) { app.call(Toy.ECHO, Echo.of(text)).text } }.awaitAll()
        }
        expect(texts, answers)
        robot.server.close()
        app.close()
    }
    tests.net("reports, and following a command to its end") {
        val robot = TestRobot()
        val app = robot.app()
        // After the first response, the robot knows the app.
        app.call(Toy.ECHO, Echo.of("hello"))
        expect(AckOutcome.TIMED_OUT, robot.server.push(Audience.ALL, Report("moved", 300, Moved, Empty).ack(AckPolicy(1, 0)), Moved.of(1))[0].outcome)
        // The report is sent once and has no receiver. The later response shows that it has been read.
        app.call(Toy.ECHO, Echo.of("behind it"))
        expect(1L, app.counters.reportsRefused)
        val reports = app.reports()
        val following = app.follow(Toy.GO, Go.of(1), Toy.MOVED) { _, _, moved -> moved.metres != 5 }
        for (metres in listOf(0, 5, 2, 3, 1)) {
            expect(AckOutcome.ACKNOWLEDGED, robot.server.push(Audience.ALL, Toy.MOVED, Moved.of(metres))[0].outcome)
        }
        val seen = following.asFlow().toList().map { "${it.javaClass.simpleName} ${it.report?.metres}" }
        expect(listOf("Going 0", "Going 2", "Ended 3"), seen)
        expect(1L, app.counters.reportsOutOfOrder)
        expect(listOf(0, 5, 2, 3, 1), List(5) { (reports.receive()?.message as Moved).metres })
        app.close()
        expect(null, reports.receive())
        robot.server.close()
    }
    tests.net("following over a loss, and after the end") {
        val first = TestRobot()
        val app = first.app()
        val following = app.follow(Toy.GO, Go.of(1), Toy.MOVED)
        first.server.close()
        val second = TestRobot(ServerConfig().address(LOCAL))
        expect("Interrupted", following.receive()?.javaClass?.simpleName)
        app.close()
        val error = runCatching { generateSequence { runBlocking { following.receive() } }.count() }.exceptionOrNull()
        expect("closed", (error as FollowError).name)
        second.server.close()
    }
    tests.net("the robot goes and comes back on the same port") {
        val first = TestRobot()
        val app = first.app()
        val port = first.server.commandAddress.port
        first.server.shutdown(1, SECONDS)
        app.states().first { !it.isConnected }
        val again = Server.bind(
            Toy,
            Service().on(Toy.ECHO) { _, request -> EchoReply.of(request.text + "!") },
            ServerConfig().address(LOCAL).commandPort(port).dataPort(0),
        )
        expect("back!", app.call(Toy.ECHO, Echo.of("back"), CallOptions().timeout(10, SECONDS)).text)
        expect(2L, app.state.connects)
        again.close()
        app.close()
    }
    tests.net("shutdown answers what is being handled") {
        val gate = CompletableDeferred<Unit>()
        val robot = TestRobot(gate = gate)
        val app = robot.app()
        kotlinx.coroutines.coroutineScope {
            val call = async(Dispatchers.Default) { app.call(Toy.GO, Go.of(1)) }
            robot.begun.await()
            val over = launch(Dispatchers.Default) { robot.server.shutdown(10, SECONDS) }
            gate.complete(Unit)
            call.await()
            over.join()
        }
        app.close()
    }
    for (limit in listOf(1, 0)) {
        tests.net("a motion whose app has gone, where $limit may run on") {
            val gate = CompletableDeferred<Unit>()
            val robot = TestRobot(ServerConfig().abandonedHandlers(limit), gate)
            val call = TestWire.bytes(FrameId(false, 1, 200, 1), "{\"metres\":1}".toByteArray())
            val socket = Socket(LOCAL, robot.server.commandAddress.port)
            socket.getOutputStream().write(call)
            val context = robot.begun.await()
            // After closing only one half, an app would still wait. This one breaks the connection.
            socket.setSoLinger(true, 0)
            socket.close()
            context.abandoned()
            if (limit == 0) robot.cancelled.await()
            gate.complete(Unit)
            if (limit == 1) robot.ended.await()
            expect(limit.toLong(), robot.server.counters.handlersAbandoned)
            robot.server.close()
        }
    }
    tests.net("shutdown under load: every call ends, and what was answered was carried out once") {
        val robot = TestRobot()
        val app = Connection.connect(Toy, robot.config().reconnect(null))
        val answered = java.util.concurrent.atomic.AtomicLong()
        val enough = CompletableDeferred<Unit>()
        val ends = kotlinx.coroutines.coroutineScope {
            val callers = (0 until 32).map {
                async(Dispatchers.Default) {
                    var error: String? = null
                    while (error == null) {
                        error = callError { app.call(Toy.GO, Go.of(1)) }
                        if (error == null && answered.incrementAndGet() == 500L) enough.complete(Unit)
                    }
                    error
                }
            }
            enough.await()
            robot.server.shutdown(5, SECONDS)
            callers.awaitAll()
        }
        expect(true, ends.all { it == "lost" || it == "closed" }) { "$ends:" }
        // Every handled request got its response.
        expect(answered.get(), robot.server.counters.callsSucceeded)
        expect(0, app.inFlight)
        app.close()
    }
    tests.net("calls over a connection that is lost again and again") {
        val robot = TestRobot()
        val app = robot.app()
        val ends = kotlinx.coroutines.coroutineScope {
            val callers = (0 until 8).map {
                async(Dispatchers.Default) {
                    List(100) { turn ->
                        // Other calls are in flight at this moment.
                        if (turn % 20 == 10) robot.server.core.loop.execute { robot.server.core.breakAll() }
                        callError { app.call(Toy.ECHO, Echo.of("again")) }
                    }
                }
            }
            callers.awaitAll().flatten()
        }
        expect(true, ends.all { it == null || it == "lost" }) { "${ends.toSet()}:" }
        expect("calm", app.call(Toy.ECHO, Echo.of("calm"), CallOptions().timeout(9, SECONDS)).text)
        expect(true, app.state.connects > 1)
        app.close()
        robot.server.close()
    }
    tests.net("an address may do what it is allowed") {
        val robot = TestRobot(ServerConfig().allow("127.0.0.0/8").allow("127.0.0.1", Effect.READ))
        val app = robot.app()
        expect("read", app.call(Toy.ECHO, Echo.of("read")).text)
        expect("refused", callError { app.call(Toy.GO, Go.of(1)) })
        expect(listOf(1L, 0L), robot.server.counters.run { listOf(callsForbidden, connectionsForbidden) })
        app.close()
        robot.server.close()
    }
    tests.net("an address that is not allowed is closed at once") {
        val robot = TestRobot(ServerConfig().allow("10.0.0.0/8", *Effect.values()))
        for (port in listOf(robot.server.commandAddress.port, robot.server.dataAddress.port)) {
            Socket(LOCAL, port).use { expect(-1, it.getInputStream().read()) }
        }
        expect(2L, robot.server.counters.connectionsForbidden)
        robot.server.close()
    }
    tests.net("a cancelled call gives its place back") {
        val gate = CompletableDeferred<Unit>()
        val robot = TestRobot(gate = gate)
        val app = Connection.connect(Toy, robot.config().limits(Toy.defaults.limits.inFlight(1)))
        kotlinx.coroutines.coroutineScope {
            val call = launch(Dispatchers.Default) { app.call(Toy.GO, Go.of(1)) }
            val context = robot.begun.await()
            expect(LOCAL, (context.peer as InetSocketAddress).hostString)
            expect(true, context.timeMs != null)
            expect("busy", callError { app.call(Toy.ECHO, Echo.of("one too many")) })
            call.cancelAndJoin()
            expect("room", app.call(Toy.ECHO, Echo.of("room")).text)
        }
        val future = app.callAsync(Toy.GO, Go.of(1))
        while (app.inFlight == 0) kotlinx.coroutines.yield()
        future.cancel(true)
        while (app.inFlight == 1) kotlinx.coroutines.yield()
        expect("room", app.call(Toy.ECHO, Echo.of("room")).text)
        gate.complete(Unit)
        robot.server.close()
        app.close()
    }
    tests.net("a first connection that cannot be made") {
        val port = ServerSocket(0).use { it.localPort }
        val error = runCatching { Connection.connect(Toy, ClientConfig().host(LOCAL).commandPort(port)) }.exceptionOrNull()
        expect("unreachable", (error as ConnectError).loss.name)
        val lazy = Connection.connectLazy(Toy, ClientConfig().host(LOCAL).commandPort(port).reconnect(Backoff().first(1, MILLISECONDS).attempts(2)))
        expect("unreachable", lazy.closed().name)
    }
    tests.net("commands without a type") {
        val service = Service()
            .onRange(0x200, 0x2FF) { _, request ->
                if (request.code == 0x2FF) throw Refusal(9, "no")
                Json.of("{\"echo\":${request.json.text}}")
            }
            .onUnknown { _, request -> Json.of(if (request.code == 1) "[]" else "{\"result\":7}") }
        val server = Server.bind(Toy, service, ServerConfig().address(LOCAL).commandPort(0).dataPort(0).log { _, _ -> })
        val app = Connection.connect(Toy, ClientConfig().host(LOCAL).commandPort(server.commandAddress.port))
        val answer = Tree.of(app.callRaw(0x200, "{\"x\":1}").json)
        expect(listOf("0", "1"), listOf(answer["result"].text, answer["echo"]["x"].text))
        expect(listOf(9L, 7L, 1L), listOf(0x2FF, 2, 1).map { app.callRaw(it, "{}").resultCode })
        expect("protocol: not implemented", Tree.of(app.callRaw(100, "{\"text\":\"\"}").json)["said"].text)
        server.close()
        app.close()
    }
    tests.net("Java: futures and listeners") {
        val robot = TestRobot()
        val app = Connection.connectAsync(Toy, robot.config()).get(9, SECONDS)
        val refused = runCatching { app.callAsync(Toy.ECHO, Echo.of("refuse")).get(9, SECONDS) }.exceptionOrNull()
        expect("refused", (refused?.cause as CallError).name)
        expect("future", app.callAsync(Toy.ECHO, Echo.of("future")).get(9, SECONDS).text)
        val data = app.data()
        val last = CompletableDeferred<ConnectionState>()
        data.onState { if (it.isClosed) last.complete(it) }
        data.connectedAsync().get(9, SECONDS)
        expect(true, data.state.isConnected)
        val subscription = data.subscribe(9, Moved)
        val streams = robot.server.streams()
        data.sendAsync(5, 7, Moved.of(3)).get(9, SECONDS)
        expect("""{"metres":3}""", String(streams.receive()!!.frame.data))
        expect(1, robot.server.sendStreamAsync(Audience.ALL, 9, 1, Moved.of(44)).get(9, SECONDS))
        expect(44, subscription.receiveAsync().get(9, SECONDS).content.metres)
        data.close()
        expect("closed_here", data.closedAsync().get(9, SECONDS).name)
        expect("closed_here", last.await().why?.name)
        val following = app.future { app.follow(Toy.GO, Go.of(1), Toy.MOVED) }.get(9, SECONDS)
        robot.server.pushAsync(Audience.ALL, Toy.MOVED, Moved.of(3)).get(9, SECONDS)
        expect(true, following.receiveAsync().get(9, SECONDS) is Followed.Ended)
        expect(null, following.receiveAsync().get(9, SECONDS))
        val heard = CompletableDeferred<Int>()
        val listening = app.onReport { heard.complete((it.message as Moved).metres) }
        robot.server.pushAsync(Audience.ALL, Toy.MOVED, Moved.of(8)).get(9, SECONDS)
        expect(8, heard.await())
        listening.close()
        expect("again", app.callAsync(Toy.ECHO, Echo.of("again")).get(9, SECONDS).text)
        robot.server.shutdownAsync(1, SECONDS).get(9, SECONDS)
        expect(0, robot.server.pushAsync(Audience.ALL, Toy.MOVED, Moved.of(8)).get(9, SECONDS).size)
        app.close()
        expect("closed_here", app.closedAsync().get(9, SECONDS).name)
        (app.core.loop as NioLoop).end()
        expect("closed", callError { app.call(Toy.ECHO, Echo.of("to nobody")) })
    }
    dataTests(tests)
    hostileTests(tests)
    exceptionTests(tests)
}

/** Unexpected exceptions do not end a thread of the runtime. */
private fun exceptionTests(tests: Tests) {
    fun Tests.surviving(name: String, body: suspend (MutableList<String>) -> Unit) = net(name) {
        val before = Thread.getDefaultUncaughtExceptionHandler()
        val uncaught = java.util.concurrent.CopyOnWriteArrayList<Throwable>()
        Thread.setDefaultUncaughtExceptionHandler { _, failure -> uncaught.add(failure) }
        try {
            body(java.util.concurrent.CopyOnWriteArrayList())
        } finally {
            Thread.setDefaultUncaughtExceptionHandler(before)
        }
        expect(listOf<Throwable>(), uncaught)
    }
    tests.surviving("tasks, timers and attempts to connect that fail") { lines ->
        val loop = NioLoop("fc-test") { level, line -> lines.add("$level $line") }
        loop.execute { throw AssertionError("secret") }
        val turned = CompletableDeferred<Thread>()
        loop.execute {
            loop.schedule(loop.now) { throw NotImplementedError("secret") }
            loop.schedule(loop.now) {
                Thread.currentThread().interrupt()
                turned.complete(Thread.currentThread())
            }
        }
        val thread = turned.await()
        for ((host, port) in listOf(LOCAL to 99_999, "no such host" to 1, "x".repeat(300) to 1, LOCAL to -1)) {
            val ended = CompletableDeferred<Exception?>()
            loop.execute { loop.connect(host, port, true) { _, failure -> ended.complete(failure) } }
            expect(true, ended.await() != null) { "$host:$port:" }
        }
        val alive = CompletableDeferred<Thread>()
        loop.execute { alive.complete(Thread.currentThread()) }
        expect(thread, alive.await())
        loop.end()
        for (name in listOf("AssertionError", "NotImplementedError")) {
            expect(1, lines.count { it.startsWith("ERROR a task of the runtime failed: ") && name in it }) { "$name in $lines:" }
        }
        expect(false, "secret" in "$lines") { "$lines" }
    }
    tests.surviving("a connection whose turn fails ends alone") { lines ->
        val loop = TestLoop()
        val config = ServerConfig().log { level, line -> if (level == LogLevel.ERROR) lines.add(line) }
        val core = ServerCore(Toy, config, loop, Service(), CoroutineScope(Dispatchers.Unconfined))
        val good = TestWire(loop)
        expect(true, core.serve(good.link, null))
        for (serve in listOf<(Link) -> Boolean>({ core.serve(it, null) }, { core.serveData(it, null) })) {
            val bad = TestLink(loop)
            expect(true, serve(Failing(bad)))
            loop.settle()
            bad.give(ByteArray(1))
            loop.settle()
            expect(true, bad.isClosed)
        }
        good.send(FrameId(false, 1, 999, 1), "{}")
        loop.settle()
        expect(1, good.frames().size)
        expect(listOf("a connection failed", "a data connection failed"), lines.map { it.substringBefore(": java.lang.IllegalStateException at ") })
        lines.clear()
        val links = ArrayDeque(listOf(Failing(TestLink(loop)), good.link))
        val never = object : Timer {
            override fun cancel() = Unit
        }
        val client = ClientConfig().log { level, line -> if (level == LogLevel.ERROR) lines.add(line) }
        val app = ClientCore(Toy, client, loop, Dial { done -> never.also { done(links.removeFirst(), null) } })
        app.begin(isFirstOnly = true)
        loop.settle()
        expect("broken", app.life.now.why?.name)
        loop.advance(1000)
        expect(listOf<Any>(2L, true, 1), listOf(app.life.now.connects, app.life.now.isConnected, lines.size))
    }
    tests.surviving("a listener of states that fails hears the next state") { lines ->
        val robot = TestRobot()
        val app = Connection.connect(Toy, robot.config().log { level, line -> lines.add("$level $line") })
        val closed = CompletableDeferred<Unit>()
        app.onState {
            if (it.isClosed) closed.complete(Unit)
            throw IllegalStateException("secret")
        }
        app.close()
        closed.await()
        expect(false, "secret" in "$lines") { "$lines" }
        robot.server.close()
    }
    tests.surviving("a listener that fails hears the next report") { lines ->
        val robot = TestRobot()
        val failed = CompletableDeferred<Unit>()
        val app = Connection.connect(Toy, robot.config().log { level, line ->
            lines.add("$level $line")
            if ("listener" in line) failed.complete(Unit)
            throw IllegalStateException("secret")
        })
        val heard = CompletableDeferred<Int>()
        app.onReport {
            val metres = (it.message as Moved).metres
            check(metres != 1) { "secret" }
            heard.complete(metres)
        }
        for (metres in 1..2) robot.server.push(Audience.ALL, Toy.MOVED, Moved.of(metres))
        expect(2, heard.await())
        failed.await()
        expect(1, lines.count { it.startsWith("ERROR the listener of reports failed: java.lang.IllegalStateException") }) { "$lines:" }
        expect(false, "secret" in "$lines") { "$lines" }
        app.close()
        robot.server.close()
    }
    tests.surviving("an address that is none") { _ ->
        for (address in listOf("no such host", "300.1.1.1", "::zz")) {
            val failure = runCatching { bindAt(address) }.exceptionOrNull()
            expect(true, failure is java.io.IOException) { "$address: $failure:" }
        }
    }
}

/** A link that fails to read. */
private class Failing(private val link: Link) : Link by link {
    override fun read(into: ByteArray): Int = throw IllegalStateException("secret")
}

private fun bindAt(address: String) = Server.bind(Toy, Service(), ServerConfig().address(address).commandPort(0).dataPort(0))

private fun dataTests(tests: Tests) {
    tests.net("streams in both directions") {
        val robot = TestRobot()
        val app = robot.app()
        app.call(Toy.ECHO, Echo.of("I am alone here"))
        val data = app.data()
        expect(1L, data.states().first { it.isConnected }.connects)
        val streams = robot.server.streams()
        data.send(5, 7, ByteArray(1_000_000) { it.toByte() })
        val came = streams.receive()!!
        expect(listOf(5, 7L, 1_000_000, 999_999.toByte()), listOf(came.frame.code, came.frame.id, came.frame.data.size, came.frame.data.last()))
        expect(1, robot.server.sendStream(Audience.one(came.connection), 6, 8, byteArrayOf(1, 2)))
        expect("0102", hex(data.receive().data))
        val connection = robot.server.connections().keys.first()
        val subscription = data.subscribe(9, Moved)
        expect(1, robot.server.sendStream(Audience.one(connection), 9, 1, Moved.of(44)))
        expect(44, subscription.receive().content.metres)
        robot.server.sendStream(Audience.ALL, 9, 1, byteArrayOf(1))
        expect("bad_json", (runCatching { subscription.receive() }.exceptionOrNull() as DataError).name)
        app.close()
        expect("closed", (runCatching { data.receive() }.exceptionOrNull() as DataError).name)
        robot.server.close()
    }
    tests.net("two apps at one address are not told apart") {
        val robot = TestRobot()
        val (one, other) = robot.app() to robot.app()
        for (app in listOf(one, other)) app.call(Toy.ECHO, Echo.of("hello"))
        val data = one.data()
        data.connected()
        data.send(1, 1, byteArrayOf(1))
        val connection = robot.server.connections().keys.first()
        val error = runCatching { robot.server.sendStream(Audience.one(connection), 1, 1, byteArrayOf(1)) }.exceptionOrNull()
        // The frame is in transit. Before it arrives, there may be no data connection.
        expect(true, (error as PushError).name in listOf("ambiguous", "no_connection"))
        listOf(one, other).forEach { it.close() }
        robot.server.close()
    }
    tests.net("a loss is told once to the receiver and once to the sender") {
        val listener = ServerSocket(0, 5, java.net.InetAddress.getByName(LOCAL))
        val robot = TestRobot()
        val app = Connection.connect(Toy, robot.config().dataPort(listener.localPort))
        val data = app.data()
        val first = listener.accept()
        data.connected()
        data.send(1, 1, byteArrayOf(1))
        first.close()
        expect("lost", (runCatching { data.receive() }.exceptionOrNull() as DataError).name)
        val second = listener.accept()
        expect("lost", (runCatching { data.send(1, 2, byteArrayOf(2)) }.exceptionOrNull() as DataError).name)
        data.send(1, 3, byteArrayOf(3))
        expect(36, DataInputStream(second.getInputStream()).run { ByteArray(36).also { readFully(it) }.size })
        app.close()
        expect("closed", (runCatching { data.send(1, 4, byteArrayOf(4)) }.exceptionOrNull() as DataError).name)
        robot.server.close()
        listener.close()
    }
}

/** Peers that close, send garbage, stop in the middle, or send data that no parser should see. */
private fun hostileTests(tests: Tests) {
    fun robot(body: suspend (Socket) -> Unit): ServerSocket {
        val listener = ServerSocket(0, 5, java.net.InetAddress.getByName(LOCAL))
        kotlin.concurrent.thread(isDaemon = true) {
            runCatching { while (true) listener.accept().use { runBlocking { body(it) } } }
        }
        return listener
    }

    suspend fun lossOf(listener: ServerSocket): String? {
        val config = ClientConfig().host(LOCAL).commandPort(listener.localPort).reconnect(null)
            .stallTimeout(30, MILLISECONDS)
        val app = Connection.connectLazy(Toy, config)
        val error = runCatching { app.call(Toy.GO, Go.of(1)) }.exceptionOrNull()
        val loss = app.closed().name
        app.close()
        listener.close()
        expect(true, (error as CallError).name in listOf("lost", "closed"))
        return loss
    }

    val call = TestWire.bytes(FrameId(false, 1, 200, 1), "{\"metres\":1}".toByteArray())
    for ((name, answer, loss) in listOf(
        Triple("closes", ByteArray(0), "closed_unheard"),
        Triple("sends garbage", "HTTP/1.1 400 Bad Request".toByteArray(), "bad_head"),
        Triple("stops in a header", call.copyOf(9), "stalled"),
        Triple("stops in a body", call.copyOf(call.size - 1), "stalled"),
    )) {
        tests.net("a robot that $name") {
            val hold = CompletableDeferred<Unit>()
            expect(loss, lossOf(robot { socket ->
                socket.getInputStream().read()
                socket.getOutputStream().write(answer)
                if (loss == "stalled") hold.await() else socket.getInputStream().read(ByteArray(4096))
            }))
            hold.complete(Unit)
        }
    }
    tests.net("an app that sends 100,000 brackets, and other bodies") {
        val robot = TestRobot()
        for ((body, result) in listOf(
            "[".repeat(100_000) to 3, "{\"text\":${"[".repeat(100_000)}" to 3, "{\"text\":\"ok\"}" to 0, "{\"text\":\u0001}" to 3, "{}" to 3,
        )) {
            Socket().use { socket ->
                socket.connect(InetSocketAddress(LOCAL, robot.server.commandAddress.port))
                socket.getOutputStream().write(TestWire.bytes(FrameId(false, 1, 100, 9), body.toByteArray()))
                val decoder = Decoder(Toy, Toy.defaults.limits)
                val scratch = ByteArray(4096)
                var frame: Frame? = null
                while (frame == null) {
                    decoder.push(scratch, 0, socket.getInputStream().read(scratch))
                    frame = decoder.next()
                }
                expect(result, Tree.of(String(frame.body))["result"].int)
            }
        }
        robot.server.close()
    }
    tests.net("an app that sends garbage is answered for what it sent before") {
        val gate = CompletableDeferred<Unit>()
        val robot = TestRobot(gate = gate)
        Socket(LOCAL, robot.server.commandAddress.port).use { socket ->
            socket.getOutputStream().write(call + "garbage".toByteArray())
            robot.begun.await()
            gate.complete(Unit)
            val received = socket.getInputStream().readBytes()
            val decoder = Decoder(Toy, Toy.defaults.limits)
            decoder.push(received, 0, received.size)
            expect(FrameId(true, 1, 200, 1), decoder.next()?.id)
        }
        robot.server.close()
    }
    tests.net("a header that does not come in time, and a frame that stalls") {
        for (config in listOf(ServerConfig().headerTimeout(20, MILLISECONDS), ServerConfig().stallTimeout(20, MILLISECONDS))) {
            val robot = TestRobot(config)
            Socket(LOCAL, robot.server.commandAddress.port).use { socket ->
                socket.getOutputStream().write(call.copyOf(20))
                expect(-1, socket.getInputStream().read())
            }
            expect(1L, robot.server.counters.connectionsTimedOut)
            robot.server.close()
        }
    }
    tests.net("too many connections from one address, of which the silent give way") {
        val robot = TestRobot(ServerConfig().connectionsPerAddress(2))
        val app = robot.app()
        app.call(Toy.ECHO, Echo.of("not silent"))
        val silent = List(3) { Socket(LOCAL, robot.server.commandAddress.port) }
        for (socket in silent.take(2)) expect(-1, socket.getInputStream().read())
        expect("still here", app.call(Toy.ECHO, Echo.of("still here")).text)
        expect(2L, robot.server.counters.connectionsDisplaced)
        silent.forEach { it.close() }
        robot.server.close()
        app.close()
    }
}
