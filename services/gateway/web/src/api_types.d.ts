// What each path of the gateway takes and gives, read off its own description (api_schema.d.ts, made by build.mjs).
import type { components, paths } from "./api_schema";

export type Method = "get" | "post" | "put" | "patch" | "delete";

/** Models by the names they have in the description. */
export type Models = components["schemas"];

type Local<P> = P extends `/v1${infer Rest}` ? Rest : never;

/** The paths, below /v1, that answer a method. */
export type PathOf<M extends Method> = {
  [P in keyof paths]: paths[P][M] extends { responses: unknown } ? Local<P> : never;
}[keyof paths];

type Operation<M extends Method, P extends PathOf<M>> = `/v1${P}` extends keyof paths ? paths[`/v1${P}`][M] : never;

type InPath<O> = O extends { parameters: { path: infer X } } ? X : unknown;

type QueryOf<O> = O extends { parameters: { query?: infer X } } ? NonNullable<X> : never;
/** What is null is left out of the address. */
type Loose<X> = { [K in keyof X]: X[K] | null };
type InQuery<O> = [QueryOf<O>] extends [never] ? unknown : Loose<QueryOf<O>>;

type BodyOf<O> = O extends { requestBody?: infer X } ? NonNullable<X> : never;
type Sent<B> = B extends { content: { "application/json": infer X } } ? X : never;
type InBody<O> = [BodyOf<O>] extends [never]
  ? unknown
  : O extends { requestBody: unknown }
    ? { body: Sent<BodyOf<O>> }
    : { body?: Sent<BodyOf<O>> };

/** All that is asked: parts of the path and of the query by name, and a body where there is one. */
export type Wish<M extends Method, P extends PathOf<M>> = InPath<Operation<M, P>> &
  InQuery<Operation<M, P>> &
  InBody<Operation<M, P>>;

/** The wish as an argument: it may be left out where nothing in it has to be said. */
export type Asked<M extends Method, P extends PathOf<M>> = {} extends Wish<M, P> ? [wish?: Wish<M, P>] : [wish: Wish<M, P>];

type Json<R> = R extends { content: { "application/json": infer X } } ? X : undefined;
type Good<R> = R extends { 200: infer X } ? X : R extends { 201: infer X } ? X : R extends { 202: infer X } ? X : undefined;

/** What comes back: undefined where there is nothing to say. */
export type Answer<M extends Method, P extends PathOf<M>> =
  Operation<M, P> extends { responses: infer R } ? Json<Good<R>> : never;
